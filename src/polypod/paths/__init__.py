"""How a foot gets there: wavefront, line of sight, slices, trajectory."""
