# Roots of Debian for the tests of packages and of other releases; bash scripts source it. What they mount is mounted in a
# namespace of its own, so that nothing stays mounted, however a script ends.
# shellcheck shell=bash

script=$(basename "$0")
readonly skipped=77 # exit status by which CTest knows that a test did not run

fail ()
{
  echo "$script: $*" >&2
  exit 1
}

skip ()
{
  echo "$script: skipped: $*" >&2
  exit "$skipped"
}

step ()
{
  echo "== $*"
}

# host_suite: the code name of the Debian that this is.
host_suite ()
{
  sed --quiet 's/^VERSION_CODENAME=//p' /etc/os-release
}

# mirrors SUITE: lines for sources.list of that release, from the mirrors that this system uses.
mirrors ()
{
  local host
  host=$(host_suite)
  # shellcheck disable=SC2016 # apt's variables and awk's
  apt-get indextargets --format '$(ORIGIN) $(CODENAME) $(REPO_URI) $(COMPONENT)' 'Created-By: Packages' |
    awk -v host="$host" -v suite="$1" '$1 == "Debian" && index($2, host) == 1 {
      print "deb", $3, suite substr($2, length(host) + 1), $4 }' |
    sort --unique
}

# apt_options: what this system's apt is set to do with the network.
apt_options ()
{
  apt-config dump | grep --extended-regexp --ignore-case \
    '^Acquire::(http|https|Retries|Check-Valid-Until|ForceIPv[46])[: ]' || true
}

# require_roots SUITE: ends the script with one line where no root of that release can be made.
require_roots ()
{
  local tool
  [[ $EUID -eq 0 ]] || skip "it needs root, to make a root of Debian"
  for tool in mmdebstrap unshare apt-get; do
    command -v "$tool" > /dev/null || skip "$tool is not installed (./install_dependencies.sh installs it)"
  done
  [[ -n $(mirrors "$1") ]] || skip "apt knows no mirror of Debian (run apt-get update)"
}

# make_root SUITE FOLDER PACKAGE...: a minimal Debian with these packages.
make_root ()
{
  local suite=$1 folder=$2 log
  shift 2
  log=$(mktemp)
  local options=()
  while IFS= read -r option; do
    options+=("--aptopt=$option")
  done < <(apt_options)
  if ! mirrors "$suite" | mmdebstrap --variant=minbase --include="$(IFS=,; echo "$*")" "${options[@]}" \
    --aptopt='APT::Install-Recommends "false"' --dpkgopt=force-unsafe-io "$suite" "$folder" - &> "$log"; then
    if grep --quiet --extended-regexp 'Could not (resolve|connect)|Failed to fetch|Temporary failure' "$log"; then
      rm --force "$log"
      skip "no mirror of Debian $suite can be reached"
    fi
    cat "$log" >&2
    rm --force "$log"
    fail "mmdebstrap failed"
  fi
  rm --force "$log"
}

# in_root FOLDER COMMAND...: runs a command in a root. What $bind_mounts names is seen there: "PLACE=PLACE_IN_ROOT ...".
in_root ()
{
  local folder=$1
  shift
  # shellcheck disable=SC2016 # the inner shell's variables
  BIND_MOUNTS=${bind_mounts:-} unshare --mount --pid --fork --kill-child --propagation private bash -euc '
    folder=$0
    mount -t proc proc "$folder/proc"
    mount --rbind /dev "$folder/dev"
    mount -t sysfs sysfs "$folder/sys" 2> /dev/null || true # containers may not
    for mount in $BIND_MOUNTS; do
      mkdir --parents "$folder/${mount#*=}"
      mount --bind "${mount%%=*}" "$folder/${mount#*=}"
    done
    unset BIND_MOUNTS
    exec env --unset=CCACHE_BASEDIR --unset=TMPDIR HOME=/tmp LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
      PATH=/usr/sbin:/usr/bin:/sbin:/bin chroot "$folder" "$@"' "$folder" "$@"
}
