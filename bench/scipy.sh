# shellcheck shell=bash
# Sets `python` to a Python with SciPy and `program` to the windfall that is measured:
# WINDFALL, or one that is built. Sourced from the top of the repository, after set-up.sh.

target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
venv=$target/faults-venv
have python3 || apt_install python3 python3-venv
if [ ! -x "$venv/bin/pip" ]; then
    rm -rf "$venv"
    python3 -m venv "$venv" 2>/dev/null || { apt_install python3-venv && python3 -m venv "$venv"; }
fi
"$venv/bin/python" -c 'import numpy, scipy' 2>/dev/null || "$venv/bin/pip" install --quiet numpy scipy
# `python` and `program` are used by the scripts that source this one.
# shellcheck disable=SC2034
python=$venv/bin/python

program=${WINDFALL:-}
if [ -z "$program" ]; then
    cargo build --release --locked -p windfall-cli --bin windfall
    program=$target/release/windfall
fi
