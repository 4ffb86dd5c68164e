# Sourced by .ci/run, .ci/everything and .ci/bare_root.sh: runs a step and says what it took.
step() {  # step NAME COMMAND...
  echo "== $1"
  shift
  local start=$SECONDS before after
  before=$(children_cpu_s)
  "$@"
  after=$(children_cpu_s)
  echo "== took $((SECONDS - start)) s, $((after - before)) s of CPU"
}

# Seconds of CPU, user and system, of all that this shell has waited for.
children_cpu_s() {
  awk -v ticks="$(getconf CLK_TCK)" '{sub(/^.*\) /, ""); printf "%d", ($14 + $15) / ticks}' "/proc/$$/stat"
}
