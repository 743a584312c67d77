# shellcheck shell=bash
# Sets `python` to a Python with the programs that recordings are compared with, and
# `target` to the build folder. Sourced from the top of the repository.

target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
venv=$target/peers-venv
# `python` is used by the scripts that source this one.
# shellcheck disable=SC2034
python=$venv/bin/python
have python3 || apt_install python3 python3-venv
if [ ! -x "$venv/bin/pip" ]; then
    rm -rf "$venv"
    python3 -m venv "$venv" 2>/dev/null || { apt_install python3-venv && python3 -m venv "$venv"; }
fi
"$venv/bin/pip" install --quiet numpy scipy npTDMS h5py soundfile pyuff pandas polars lvm_read openpyxl XlsxWriter odfpy
