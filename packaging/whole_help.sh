#!/bin/sh
# --help of the program $SPLATCUT and of all its commands, for help2man. What CLI11 says of an option beside its values
# is left out.
[ "$1" != --version ] || exec "$SPLATCUT" --version
plain() {
  sed -E '/^(Positionals|Options):$/d; /^Usage:/d; s/^(  -.),--/\1, --/; s/ (Excludes|Needs):( --[a-z-]+)+//
    s/ [A-Z]+:(\{|[A-Z])/ \1/; s/\{false\}//; s/ REQUIRED/ (required)/; s/(\]|\)) ([A-Z])/\1  \2/'
}
whole=$("$SPLATCUT" --help)
example=$(printf '%s\n' "$whole" | grep '^Example:')  # which commands without an example of their own repeat
printf '%s\n' "$whole" | sed '/^Subcommands:/,/^$/d; /^Usage:/d' | plain
printf '%s\n' "$whole" | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p' | while read -r command; do
  printf '\n*splatcut %s*\n' "$command"
  "$SPLATCUT" "$command" --help | plain | grep -vxF -e "$example" | grep -v "^  -h, --help"
done
