# Sourced by .ci/run and .ci/everything: runs a step and says what it took.
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
children_cpu_s() { times | awk 'NR == 2 {gsub(/[ms]/, " "); printf "%d", 60 * $1 + $2 + 60 * $3 + $4}'; }
