"""What holds for all tests, before NumPy is imported anywhere."""

import os

# Two test processes on two cores: threads of the linear algebra would only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
