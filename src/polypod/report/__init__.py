"""What a walk was like: record, figures, pictures."""
