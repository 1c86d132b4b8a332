def runs_avx2() -> bool:
    """Whether processor and operating system run AVX2."""
