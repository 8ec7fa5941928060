"""Environment for linear algebra on one thread; a module of its own, because the program sets it before all imports."""

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "BLIS_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)
"""Variables and values; a library reads the variables when the library is loaded."""
