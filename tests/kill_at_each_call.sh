#!/usr/bin/env bash
# tests/kill_at_each_call.sh: runs a cut over an older cutout and kills it just before each of its calls that name,
# rename, link or remove a file, one run a call; wants strace. Each time the folder must be the old or the new cutout as
# a whole, files of others must be there, and the next run must clean. Prints a line a call; ends with 1 where one is
# wrong. "beside": a folder of others lies in out.splatcut.new until the next run.
set -uo pipefail
build=$(cd "${BUILD:-$(dirname "$0")/../build/release}" && pwd)
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place" || exit 1
export XDG_CACHE_HOME=$place/cache
"$build/splatcut-lab" make-scene a -o a --gaussians 20000 --quiet
cut() { # CLICK [PROGRAM that runs it]
  "${@:2}" "$build/splatcut" cut a/a.ply --cameras a/cameras.json --camera 0 --click "$1" -o out --overwrite --quiet
}
contents() { # without times and files of others
  (cd out && find . -type f ! -name '*.txt' ! -name '*.jpg' | sort | while read -r file; do
    echo "$file $(grep -aEv '"(ms|total_ms|peak_rss_mb)"' "$file" | sha256sum)"
  done)
}
cut 494,430
mkdir out/photos && echo mine >out/notes.txt && echo mine >out/photos/a.jpg
old=$(contents)
cp -a out old
cut 670,490
new=$(contents)
wrong=0
for call in mkdir flock ftruncate pwrite64 fsync rename link renameat2 unlink rmdir; do
  for ((nth = 1; nth < 100; ++nth)); do
    rm -rf out out.splatcut.*
    cp -a old out
    cut 670,490 strace -f -o trace -e trace=$call -e inject=$call:signal=KILL:when=$nth >/dev/null 2>&1 && break
    is=mixed notes=lost photos=beside next=wrong
    [ "$(contents)" = "$old" ] && is=old
    [ "$(contents)" = "$new" ] && is=new
    [ "$(cat out/notes.txt 2>/dev/null)" = mine ] && notes=there
    [ -e out/photos/a.jpg ] && photos=there
    cut 670,490 && [ "$(contents)$(cat out/notes.txt out/photos/a.jpg)" = "${new}mine
mine" ] && ! compgen -G '*.splatcut.*' >/dev/null && next=cleaned
    echo "$call $nth: $is, notes $notes, photos $photos, next run $next"
    case "$is $notes $next" in *mixed* | *lost* | *wrong*) wrong=1 ;; esac
  done
done 2>/dev/null
exit $wrong
