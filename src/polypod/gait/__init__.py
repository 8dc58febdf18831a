"""When each foot swings: disks, the library of gaits, the needle, transitions."""
