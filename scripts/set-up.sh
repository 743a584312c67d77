# shellcheck shell=sh
# Installs what windfall needs to build, if it is missing: a C compiler (for the
# bundled SQLite) and a Rust toolchain. Sourced by the other scripts, from the top
# of the repository; does nothing if nothing is missing.

say() {
    printf '%s\n' "$*" >&2
}

fail() {
    say "set-up: $*"
    exit 1
}

have() {
    command -v "$1" >/dev/null 2>&1
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# Installs Debian packages.
apt_install() {
    have apt-get || fail "this machine has no apt-get; install these by hand and run again: $*"
    [ "$(id -u)" -eq 0 ] || have sudo ||
        fail "installing needs root, and there is no sudo; as root run: apt-get install $*"
    say "set-up: installing $*"
    as_root apt-get update -qq || say "set-up: apt-get update failed; trying with the lists that are there"
    as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get -o DPkg::Lock::Timeout=300 install -y -qq --no-install-recommends "$@" >/dev/null ||
        fail "apt-get could not install: $*"
}

need_c_compiler() {
    have cc || apt_install gcc libc6-dev
    have cc || fail "there is still no C compiler called cc; install gcc or clang and run again"
}

# Whether version $1 is at least version $2.
at_least() {
    [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]
}

# Version of the cargo that would run here; empty if there is none.
cargo_version() {
    # A rustup without a toolchain has a cargo that fails.
    cargo --version 2>/dev/null | cut -d ' ' -f 2
}

install_rustup() {
    if have apt-cache && LC_ALL=C apt-cache policy rustup | grep -q 'Candidate: [0-9]'; then
        apt_install rustup
        return
    fi
    have curl || apt_install curl ca-certificates
    installer=$(mktemp)
    for address in https://static.rust-lang.org/rustup/rustup-init.sh https://sh.rustup.rs; do
        say "set-up: fetching the Rust installer from $address"
        if curl --proto '=https' --tlsv1.2 -fsSL --retry 3 -o "$installer" "$address"; then
            sh "$installer" -y -q --profile minimal --no-modify-path --default-toolchain none ||
                fail "the Rust installer failed"
            rm -f "$installer"
            return
        fi
    done
    rm -f "$installer"
    fail "cannot reach the Rust installer; install Rust $rust_wanted or newer from https://rustup.rs and run again"
}

need_cargo() {
    rust_wanted=$(sed -n 's/^rust-version = "\(.*\)"$/\1/p' Cargo.toml)
    PATH="${CARGO_HOME:-${HOME:-}/.cargo}/bin:$PATH"
    export PATH
    rust_found=$(cargo_version)
    if [ -n "$rust_found" ] && at_least "$rust_found" "$rust_wanted"; then
        return
    fi
    say "set-up: windfall needs Rust $rust_wanted or newer; found ${rust_found:-none}"
    have rustup || install_rustup
    rustup toolchain install stable --profile minimal --no-self-update >&2 ||
        fail "rustup could not install the stable toolchain"
    RUSTUP_TOOLCHAIN=stable
    export RUSTUP_TOOLCHAIN
    rust_found=$(cargo_version)
    if [ -z "$rust_found" ] || ! at_least "$rust_found" "$rust_wanted"; then
        fail "needs Rust $rust_wanted, but cargo is ${rust_found:-missing}; remove the older cargo from PATH and run again"
    fi
}

# Node 20.19 or newer, to build and test the page; kept in folder $1 if the system's
# own is older. Users of windfall do not need it.
need_node() {
    node_wanted=20.19.0
    PATH=$1/node_modules/.bin:$PATH
    export PATH
    node_found=$(node --version 2>/dev/null | sed 's/^v//')
    if [ -n "$node_found" ] && at_least "$node_found" "$node_wanted" && have npm; then
        return
    fi
    say "set-up: the page needs Node $node_wanted or newer; found ${node_found:-none}"
    have npm || apt_install npm
    # The registry has Node itself as a package. It gets its own npm, because Debian's
    # npm works only with Debian's Node.
    npm install --prefix "$1" --no-save --no-audit --no-fund --loglevel=error node@22 npm@10 >/dev/null ||
        fail "npm could not install Node; install Node $node_wanted or newer and run again"
    node_found=$(node --version | sed 's/^v//')
    at_least "$node_found" "$node_wanted" || fail "needs Node $node_wanted, but node is $node_found"
}

# Python 3.11 or newer with venv, to test the package for Python, which needs 3.10.
need_python() {
    python_fits() {
        python3 -c 'import sys, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null
    }
    python_fits || apt_install python3 python3-venv
    python_fits || fail "needs Python 3.11 or newer with venv; install it and run again"
}

# A browser for the tests of the page.
need_chromium() {
    have chromium || have chromium-browser || have google-chrome || apt_install chromium
}

# The engines on which tests run scenes for comparison.
need_engines() {
    missing=
    have lmp || missing="$missing lammps"
    have mpirun || missing="$missing openmpi-bin"
    have liggghts || missing="$missing liggghts"
    # shellcheck disable=SC2086 # a list of packages
    [ -z "$missing" ] || apt_install $missing
}

need_c_compiler
need_cargo
