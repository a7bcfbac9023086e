# Shared by demo, test, test_threads and package: their packages and their workspace.
# To be sourced; sets strict mode and ends all children when the script ends.
# shellcheck shell=bash

set -euo pipefail

# A script started in the background of another one ignores Ctrl-C, which bash cannot undo; a
# restart can.
if (( 0x$(awk '/^SigIgn/ { print substr($2, length($2)) }' /proc/$$/status) & 2 )); then
  exec env --default-signal=INT bash "$0" "$@"
fi

# Another python3 or another ROS workspace in the environment breaks catkin and ROS scripts. With
# CDPATH, cd may print where it goes; the makefiles below are those of CMake's default generator.
export PATH="/usr/bin:/usr/sbin:/bin:/sbin:$PATH"
unset PYTHONHOME PYTHONPATH CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_IP ROS_NAMESPACE
unset CDPATH CMAKE_GENERATOR
export PYTHONNOUSERSITE=1  # the user's own em or numpy would come before Debian's
export PYTHONDONTWRITEBYTECODE=1
export ROS_HOSTNAME=localhost
# Message code in a language that nothing here speaks.
export ROS_LANG_DISABLE=genlisp
# CMake 4 would refuse catkin's own toplevel.cmake.
export CMAKE_POLICY_VERSION_MINIMUM=3.5

bringup=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
clone=$(dirname "$bringup")
workspace=${WIIMOTE_TRACKER_WORKSPACE:-$clone/.workspace}

say() { printf '%s\n' "$*"; }
step() { printf '\n== %s\n' "$*"; }
fail() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# ROS nodes find each other by this name; bare chroots lack it.
getent hosts localhost >/dev/null ||
  fail "this computer does not know its own name localhost; add the line '127.0.0.1 localhost' to /etc/hosts"

# --- Children: each step runs in its own process group, so that all of it can be ended.

child=
run() {
  set -m
  "$@" </dev/null 9>&- &
  child=$!
  set +m
  local status=0
  wait "$child" || status=$?
  child=
  return "$status"
}

signal_child() {
  kill "-$1" -- "-$child" 2>/dev/null && return
  # A step that runs as root can only be signalled by root.
  [[ $EUID -ne 0 && -d /proc/$child ]] && sudo -n kill "-$1" -- "-$child" 2>/dev/null
}

# Whether any process of the step's group is left.
child_alive() { kill -0 -- "-$child" 2>/dev/null || [[ -d /proc/$child ]]; }

end_child() {
  [[ -n $child ]] || return 0
  local signal
  for signal in TERM KILL; do
    signal_child "$signal" || true
    for _ in $(seq 200); do
      child_alive || { child=; return 0; }
      sleep 0.1
    done
  done
}

on_signal() {
  trap '' INT TERM HUP
  say ""
  say "Interrupted: ending what was started."
  exit "$1"  # The exit trap does the rest.
}
trap 'on_signal 130' INT
trap 'on_signal 143' TERM
trap 'on_signal 129' HUP
trap end_child EXIT

# --- Packages

# Those of these packages that are not installed.
not_installed() {
  # dpkg-query fails when it has never heard of one of them.
  comm -23 <(printf '%s\n' "$@" | sort -u) <(
    { dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null || true; } |
      awk '$2 == "installed" { print $1 }' | sort -u)
}

# Those of these packages that this release of Debian has.
available() {
  local package
  for package; do
    [[ -z $(apt-cache madison "$package" 2>/dev/null) ]] || printf '%s\n' "$package"
  done
}

# install_missing_packages LIST...: the packages in these files. One that is marked with "?" is left
# out where this release of Debian does not have it.
install_missing_packages() {
  command -v apt-get >/dev/null && command -v dpkg-query >/dev/null ||
    fail "this needs apt-get (Debian 11 to 13); on another system install what package.xml names and use catkin_make"
  local needed optional missing root=()
  # shellcheck disable=SC2046
  needed=$(not_installed $(grep -hv '^#' "$@" | grep -v '?'))
  # shellcheck disable=SC2046
  optional=$(not_installed $(grep -hv '^#' "$@" | sed -n 's/ *?$//p'))
  # shellcheck disable=SC2086
  missing="$needed $(available $optional)"
  [[ -n ${missing// /} ]] || return 0

  # shellcheck disable=SC2086
  step "Installing $(wc -w <<<"$missing") Debian packages:" $missing
  if [[ $EUID -ne 0 ]]; then
    command -v sudo >/dev/null && { sudo -n true 2>/dev/null || { [[ -t 0 ]] && sudo -v; }; } ||
      fail "Debian packages are missing and need root; run as root: apt-get install --no-install-recommends" $missing
    root=(sudo -n)
  fi
  local apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive)
  run "${apt[@]}" dpkg --configure -a || true  # repairs an interrupted installation
  run "${apt[@]}" apt-get update ||
    fail "apt-get update failed (see above); check the network and /etc/apt/sources.list"
  # Once more: a new Debian knows no packages before.
  # shellcheck disable=SC2046,SC2086
  run "${apt[@]}" apt-get install -y --no-install-recommends $needed $(available $optional) ||
    fail "apt-get could not install the missing packages (see above); on Debian 11 to 13 all of them are in main"
}

# --- Workspace

# Jobs: one per processor, but no more than memory allows (1.7 GB for the largest compiler run): that
# of the computer [kB], and that of a container [bytes], by version 2 or 1 of control groups.
jobs_that_fit() {
  local groups=/sys/fs/cgroup
  { cat /proc/meminfo $groups/memory.max $groups/memory/memory.limit_in_bytes 2>/dev/null || true; } |
    awk -v cpus="$(nproc)" '
      BEGIN { n = cpus + 0 }
      /^MemAvailable/ { fit = int($2 / 1.7e6); if (fit < n) n = fit }
      /^[0-9]+$/ { fit = int($1 / 1.7e9); if (fit < n) n = fit }
      END { print n < 1 ? 1 : n }'
}

# Makes the workspace and locks it until the script ends.
prepare_workspace() {
  # An earlier run may have been another user's.
  mkdir -p "$workspace/src" && [[ -w $workspace && -w $workspace/src ]] ||
    fail "cannot write to $workspace; set WIIMOTE_TRACKER_WORKSPACE to a folder that can be written"
  workspace=$(cd "$workspace" && pwd -P)
  exec 9>"$workspace/.lock"
  flock -n 9 || fail "another demo or test uses $workspace; wait for it, or set WIIMOTE_TRACKER_WORKSPACE to another folder"
  # The clone may be in the src folder of another workspace, which must not find ours in it.
  touch "$workspace/CATKIN_IGNORE"
  local package
  find "$workspace/src" -maxdepth 1 -type l -name 'wiimote_tracker_*' -delete
  for package in "$clone"/wiimote_tracker_*/package.xml; do
    ln -s "$(dirname "$package")" "$workspace/src/"
  done
}

# make_workspace [make targets or CMake arguments]
# Demo and tests share the build, so both build with these flags. Without debug information: even
# -g1 takes 9 to 16 % of the compiler's time.
# Debian 11's catkin loses the gtest targets of GMock's CMake package when CMake runs again.
make_workspace() {
  catkin_make -C "$workspace" -j"$(jobs_that_fit)" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_CXX_FLAGS_RELEASE="-O2 -DNDEBUG" -DWIIMOTE_TRACKER_WERROR=ON \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_DISABLE_FIND_PACKAGE_GMock=ON "$@"
}

# make_with_progress TARGET [CMake arguments]: the same, but prints only how far it is; build.log has
# the rest. Compiler runs count, since other steps take no time.
make_with_progress() {
  local line percent begun=0 total=0 shown=0
  make_workspace "$@" 2>&1 | tee "$workspace/build.log" | while IFS= read -r line; do
    [[ $line = *'Building CXX object'* ]] || continue
    if (( total == 0 )); then
      # Make fails where sources are not generated yet; their compiler runs do not count.
      total=$({ make -C "$workspace/build" -nk "$1" 2>/dev/null || true; } |
        grep -c 'Building CXX object' || true)
      SECONDS=0
    fi
    percent=$(( 100 * begun / (total > begun ? total : begun + 1) ))
    begun=$(( begun + 1 ))
    (( percent >= shown + 5 && percent < 100 )) || continue
    shown=$percent
    say "  $percent %, about $(( SECONDS * (100 - percent) / percent / 60 + 1 )) min left"
  done
}

# configure_sanitized BUILD SANITIZERS [PACKAGES]: configures a second build of the workspace, of
# these packages (separated by ";"; default: all).
# Left out of the checks (in CMakeLists.txt): null and alignment, which double the compile time; the
# address sanitizer stops at a null access, and Eigen's assertions at misaligned memory.
configure_sanitized() {
  mkdir -p "$1"
  # As catkin_make does, which need not have run yet.
  [[ -e $workspace/src/CMakeLists.txt ]] || catkin_init_workspace "$workspace/src" >/dev/null
  cmake -S "$workspace/src" -B "$1" -DCATKIN_DEVEL_PREFIX="$workspace/devel_${1##*build_}" \
    -DWIIMOTE_TRACKER_SANITIZE="$2" -DCATKIN_WHITELIST_PACKAGES="${3:-}" -DCATKIN_ENABLE_TESTING=ON \
    -DCMAKE_DISABLE_FIND_PACKAGE_GMock=ON \
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1 -gz" >"$1/cmake.log" ||
    fail "the sanitizer build could not be configured; see $1/cmake.log"
}

# run_tests BUILD JOBS TESTS: runs the tests whose type and name begin so (a regular expression), and
# builds what they still need. By CMake's inner makefile, since the outer one makes one target after
# the other. A failure does not end the script: the callers read the result files.
run_tests() {
  local goals
  mapfile -t goals < <(
    grep -oE '^[^:[:space:]]*/run_tests_wiimote_tracker_[a-z]+_[a-z-]+_[^:/]+\.dir/all' "$1/CMakeFiles/Makefile2" |
      grep -E "/run_tests_wiimote_tracker_[a-z]+_($3)" | sort -u)
  [[ ${#goals[@]} -gt 0 ]] || fail "no test $3 was found in $workspace/src"
  # Without a path to libraries of this or another build: catkin gives each test its own.
  env -u LD_LIBRARY_PATH make -C "$1" -f CMakeFiles/Makefile2 -j"$2" --output-sync=target -k \
    "${goals[@]}" || true
}

use_workspace() {
  set +u
  # shellcheck disable=SC1090,SC1091
  source "$workspace/devel/setup.bash"
  set -u
}
