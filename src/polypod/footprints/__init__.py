"""Where a foot lands: the preferred place, candidates and their scores."""
