# debian.sh - shell functions of the scripts that build on Debian 12; sourced, with the repository as the working folder.

frond_packages="build-essential cmake pkg-config petsc-dev libopenmpi-dev libhdf5-openmpi-dev zlib1g-dev python3-numpy python3-h5py python3-matplotlib"

# frond_install PACKAGE...: install those that are missing, as root or through sudo.
frond_install() {
  missing=""
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
  done
  [ -z "$missing" ] && return 0
  if ! command -v apt-get >/dev/null; then
    echo "not a Debian system: install what these packages hold yourself:$missing" >&2
    return 1
  fi
  as_root=""
  if [ "$(id -u)" -ne 0 ]; then as_root="sudo"; fi
  echo "installing:$missing"
  $as_root apt-get update -qq
  $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
}

# frond_build FOLDER TARGET [cmake options]: configure and build.
frond_build() {
  folder=$1 target=$2
  shift 2
  cmake -S . -B "$folder" -DCMAKE_BUILD_TYPE=Release "$@"
  cmake --build "$folder" --target "$target" -j "$(nproc)"
}
