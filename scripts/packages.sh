# Sourced by quickstart.sh and test.sh: installs what is missing of cmake/packages.txt, and says so.
#
#     install_packages GROUP...      groups: build, test, bench

# Packages of the groups named that are not installed, one a line.
missing_packages() {
    local group package command
    while read -r group package command; do
        # A tool that came from elsewhere (Node.js of another source conflicts with Debian's npm) serves as well.
        if [ -n "$command" ] && command -v "$command" >/dev/null; then
            continue
        fi
        for wanted in "$@"; do
            if [ "$group" = "$wanted" ] && ! dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed'; then
                echo "$package"
            fi
        done
    done < <(grep -v '^#' cmake/packages.txt)
}

install_packages() {
    local packages as_root=()
    packages=$(missing_packages "$@")
    if [ -z "$packages" ]; then
        echo "Every Debian package that is needed is installed."
        return
    fi
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "error: these Debian packages are missing, and neither root nor sudo is at hand:" $packages >&2
            return 1
        fi
        as_root=(sudo)
    fi
    echo "Installing Debian packages through apt:" $packages
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q
    # shellcheck disable=SC2086  # a list of words
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $packages
}

# Configures and builds to build/; CMake options may follow.
build_burin() {
    echo "Building to build/ ..."
    cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release "$@"
    cmake --build build --parallel "$(nproc)"
}
