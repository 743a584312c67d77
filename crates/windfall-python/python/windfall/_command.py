"""The program `windfall`."""

from __future__ import annotations

import signal
import sys

from windfall import _native


def main() -> int:
    """Does what the command line says; the exit status."""
    # Ctrl-C ends the program at once, as it ends others.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.main(sys.argv)


if __name__ == "__main__":
    sys.exit(main())
