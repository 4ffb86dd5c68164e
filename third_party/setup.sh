# Sourced by run.sh, test.sh and .ci/: installs what is missing, builds. Expects `root`, the project's folder.

# Of the lists named (files of this folder).
install_missing_packages() {
  local missing=() package
  while read -r package; do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done < <(cd "$root/third_party" && grep -hv '^#' "$@")
  [ ${#missing[@]} -eq 0 ] && return
  echo "Installing with apt-get: ${missing[*]}"
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "These packages need root: run this as root or install sudo." >&2; exit 1; }
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

build_preset() {  # build_preset PRESET [TARGET...]
  (cd "$root" && cmake --preset "$1" >/dev/null && cmake --build --preset "$1" -- "${@:2}")
}
