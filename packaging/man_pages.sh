#!/bin/sh
# Writes man pages of the commands in a folder of executables, one for each subcommand too, from what --help says.
#   man_pages.sh BIN OUT VERSION
set -eu
bin=$1 out=$2 version=$3
PATH=$bin:$PATH
export PATH
rm -rf "$out"
mkdir -p "$out"
cd "$out"

page() {  # COMMAND NAME: its man page; the first sentence of its help is its name line
  name=$($1 --help | sed -n '1{s/^mixloop[a-z-]*: //;s/\. .*//;s/\.$//;p}')
  help2man --no-info --no-discard-stderr --version-string "$version" --manual mixloop --source mixloop \
    --name "$name" --output "$2.1" "$1"
  sed -i '/^\.SH NAME/{n;s/^mixloop \([a-z]*\) /mixloop-\1 /}' "$2.1"  # as whatis and apropos have it
}

for program in mixloop mixloop-plant mixloop-controller mixloop-planner; do page "$program" "$program"; done
for command in $(mixloop --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p'); do
  page "mixloop $command" "mixloop-$command"
done
gzip -9n ./*.1
