# Sourced by .ci/bare_debian.sh and .ci/package: makes a bare Debian 12 root in $bare, from this machine's mirror, and runs
# commands in it. As root. The root goes when all is well; `keep=--keep`: stays. What is said goes to $log.
source .ci/steps.sh
me=$(basename "$0")
stop() { echo "$me: $1" >&2; exit 1; }
[ "$(id -u)" -eq 0 ] || stop "a chroot needs root: run this as root."
command -v mmdebstrap >/dev/null || stop "mmdebstrap is missing: apt-get install mmdebstrap (apt-packages-gate.txt)."
suite=bookworm
mirror=$(apt-get indextargets --format '$(REPO_URI) $(RELEASE)' | awk -v s=$suite '$2 == s {print $1; exit}')
[ -n "$mirror" ] || stop "apt knows no mirror of Debian 12 ($suite): add one to /etc/apt/sources.list.d."

bare=$(mktemp -d /var/tmp/splatcut_bare.XXXXXX)
log=$bare.log
mounted=()
leave_root() {
  local code=$? point
  for point in "${mounted[@]}"; do umount --recursive "$point" || code=1; done
  if [ "$code" -eq 0 ] && [ "${keep:-}" != --keep ]; then
    rm -rf --one-file-system "$bare" "$log"
  else
    echo "The root is $bare, what was said is in $log." >&2
  fi
  exit $code
}
trap leave_root EXIT

make_root() {
  echo "== a bare Debian 12 from $mirror"
  mmdebstrap --variant=minbase --include=ca-certificates $suite "$bare" "$mirror" >"$log" 2>&1 ||
    stop "mmdebstrap failed: $(tail -n 1 "$log")"
  # How this machine's apt reaches the mirror.
  apt-config dump | grep -E '^(Acquire::(http|https|Check)|DPkg::Lock)' >"$bare/etc/apt/apt.conf.d/90mirror" || true
  cp /etc/resolv.conf /etc/hosts "$bare/etc/"
  local point
  for point in proc dev; do
    mount --rbind "/$point" "$bare/$point" || stop "cannot mount /$point: this sandbox forbids it."
    mount --make-rslave "$bare/$point"
    mounted=("$bare/$point" "${mounted[@]}")
  done
  mkdir "$bare/splatcut"
}

# Runs a line of bash in the root's folder /splatcut; stops where it fails.
inside() { step "$*" inside_quietly "$@"; }
inside_quietly() {
  chroot "$bare" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    bash -c "cd /splatcut && $*" >>"$log" 2>&1 || { tail -n 40 "$log"; stop "$* failed."; }
}
