# SPDX-License-Identifier: MIT
# What bash completes of our commands.   bash completion.sh SOURCE BIN
set -eu
PATH=$2:$PATH
. "$1/packaging/mixloop.bash"

completes() {  # EXPECTED WORD...: of these words the last is completed so
  local expected=$1
  shift
  COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
  _mixloop
  [ "${COMPREPLY[*]}" = "$expected" ] || { echo "'$*' is completed by '${COMPREPLY[*]}'; expected '$expected'"; exit 1; }
}

completes track mixloop tra
completes --baseline mixloop track --ba
completes --baseline mixloop track experiments/paper.yaml --ba
completes --patience mixloop-plant --pat
cd "$1"
completes experiments/paper_continuous.yaml mixloop simulate experiments/paper_
