"""FMUs for tests, compiled from C by the compiler of this machine."""
