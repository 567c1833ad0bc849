"""`python -m tests.fuzz`: all inputs for all readers, with their count."""

import sys
from pathlib import Path

import pytest

if __name__ == "__main__":
    sys.exit(pytest.main([str(Path(__file__).parent), "-m", "slow", "-q", "-p", "no:cacheprovider"]))
