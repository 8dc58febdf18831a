"""What the command line's subcommands do; a module each, imported when its job is asked for."""
