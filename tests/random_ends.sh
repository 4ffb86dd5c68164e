#!/usr/bin/env bash
# tests/random_ends.sh [ROUNDS]: ends cut, convert, render and eval over an older output ROUNDS times each (200), at random
# moments, by INT, TERM, HUP and KILL in turn, and looks at what is there: the old or the new as a whole, files of
# others untouched, nothing left over; after KILL, the next run cleans. Half of the moments lie near the end, where
# outputs are written. Prints counts; ends with 1 where one was wrong. SEED chooses other moments, BUILD other
# programs, COMMANDS some of them.
set -uo pipefail
rounds=${1:-200}
RANDOM=${SEED:-1}
build=$(cd "${BUILD:-$(dirname "$0")/../build/release}" && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place" || exit 1
export XDG_CACHE_HOME=$place/cache
for name in a b; do "$build/splatcut-lab" make-scene $name -o $name --gaussians 60000 --quiet --sh-degree 1; done
"$build/splatcut" convert b/b.ply -o b.splat --quiet  # other bytes than a.ply

run() { # COMMAND old|new: its words, without the program
  local view=0 click=670,490 scene=a/a.ply
  [ "$2" = old ] && view=1 click=494,430 scene=b.splat
  case $1 in
    cut) echo "cut a/a.ply --cameras a/cameras.json --camera 0 --click $click -o out" ;;
    convert) echo "convert $scene -o out" ;;
    render) echo "render a/a.ply --cameras a/cameras.json --camera $view -o out" ;;
    eval) echo "eval a/suite.json --only $([ "$2" = old ] && echo orange || echo apple) --no-curve -o out" ;;
  esac
}
target() { [ "$1" = convert ] && echo out.spz || echo out; }

# What is there, without times and without files of others.
contents() {
  if [ -d "$1" ]; then
    (cd "$1" && find . -type f ! -name '*.txt' ! -name '*.jpg' | sort | while read -r file; do
      case $file in
        */eval.json) echo "$file $(grep -aE '"name"|iou|psnr|ssim' "$file" | sha256sum) $(tail -c 2 "$file")" ;;
        *) echo "$file $(grep -aEv '"(ms|total_ms|peak_rss_mb)"' "$file" | sha256sum)" ;;
      esac
    done)
  else
    sha256sum <"$1"
  fi
}
foreign_is_there() { [ ! -d "$1" ] || { [ "$(cat "$1/notes.txt")" = mine ] && [ "$(cat "$1/photos/a.jpg")" = mine ]; }; }
leftovers() { find . -name '*.splatcut.*' | grep -c .; }
now_ms() { date +%s%3N; }

wrong=0
for command in ${COMMANDS:-cut convert render eval}; do
  out=$(target $command)
  program() { # old|new, in the background; $! is the program itself
    local words
    words=$(run $command "$1")
    exec "$build/splatcut$([ $command != eval ] || echo -lab)" ${words/%out/$out} --overwrite --quiet >/dev/null 2>&1
  }
  (program old)
  if [ -d "$out" ]; then mkdir "$out/photos"; echo mine >"$out/notes.txt"; echo mine >"$out/photos/a.jpg"; fi
  old=$(contents $out)
  cp -a $out old
  start=$(now_ms)
  (program new)
  took_ms=$(($(now_ms) - start))
  new=$(contents $out)
  [ "$old" != "$new" ] || { echo "$command: old and new are alike"; exit 1; }
  for signal in INT TERM HUP KILL; do
    was_old=0 was_new=0 mixed=0 lost=0 left=0 not_cleaned=0
    for ((round = 0; round < rounds / 4; ++round)); do
      rm -rf $out
      cp -a old $out
      share=$((RANDOM % 1000))
      [ $((round % 2)) = 0 ] && share=$((700 + RANDOM % 350))
      (program new) &
      sleep "$(awk "BEGIN {print $took_ms * $share / 1e6}")"
      kill -$signal $! 2>/dev/null
      wait $! 2>/dev/null
      is=$(contents $out)
      if [ "$is" = "$old" ]; then was_old=$((was_old + 1)); elif [ "$is" = "$new" ]; then was_new=$((was_new + 1)); else mixed=$((mixed + 1)); fi
      foreign_is_there $out || lost=$((lost + 1))
      [ "$(leftovers)" = 0 ] || left=$((left + 1))
      if [ $signal = KILL ]; then
        (program new)
        [ "$(contents $out)" = "$new" ] && foreign_is_there $out && [ "$(leftovers)" = 0 ] || not_cleaned=$((not_cleaned + 1))
      fi
    done
    [ $signal = KILL ] || not_cleaned=$((not_cleaned + left))
    wrong=$((wrong + mixed + lost + not_cleaned))
    printf '%-8s %-5s old %3d  new %3d  mixed %d  lost %d  left over %d  not cleaned %d\n' \
      $command $signal $was_old $was_new $mixed $lost $left $not_cleaned
  done
  rm -rf old $out
done
[ $wrong = 0 ]
