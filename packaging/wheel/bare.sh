#!/bin/sh
# A wheel of sms on a system that has Python and nothing to compile with: from nothing to a verdict, timed.
#
#   packaging/wheel/bare.sh WHEELS SUITE [MIRROR]
#
# Installs Debian's or Ubuntu's SUITE with Python into WHEELS/bare (debootstrap fetches about 60 MB from MIRROR, by
# default this machine's; the folder is kept, and used again), then in it: pip installs the wheel of the folder WHEELS
# that fits, with its dependencies from the package index, and `sms demo` runs. Needs root.
set -eu
[ $# = 2 ] || [ $# = 3 ] || { echo "usage: $0 WHEELS SUITE [MIRROR]" >&2; exit 2; }
wheels=$1 suite=$2

fail() {
  printf '%s: %s\n' "$0" "$*" >&2
  exit 1
}

[ -n "$(find "$wheels" -maxdepth 1 -name 'sms-*.whl' 2>/dev/null)" ] || fail "there is no wheel in $wheels; ./dev wheel makes one"
system=$(cd "$wheels" && pwd)/bare/$suite

[ "$(id -u)" = 0 ] || fail "a system of its own (chroot) needs root"
if [ ! -e "$system/made" ]; then
  command -v debootstrap >/dev/null || fail "debootstrap is missing: apt-get install debootstrap"
  # shellcheck disable=SC2016  # apt fills this in
  mirror=${3-$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Component: main' | head -n 1)}
  mkdir -p "$system"
  # A suite younger than this debootstrap is bootstrapped as its elders are.
  case $mirror in
    *ubuntu*) script=gutsy components=main,universe keys=--no-check-gpg ;; # Debian has none of Ubuntu's keys
    *) script=sid components=main keys= ;;
  esac
  # shellcheck disable=SC2086  # an option or none
  debootstrap $keys --variant=minbase --components=$components --include=python3,python3-venv,ca-certificates \
    "$suite" "$system" "$mirror" "/usr/share/debootstrap/scripts/$script" >"$system.log" 2>&1 ||
    fail "debootstrap failed; all of its output is in $system.log"
  touch "$system/made"
fi

# The wheels, and what a machine behind a proxy needs to reach the package index: its name server and certificates.
rm -rf "$system/try"
mkdir -p "$system/try"
cp "$wheels"/sms-*.whl "$system/try"
cp /etc/resolv.conf "$system/etc/resolv.conf"
cp /etc/ssl/certs/ca-certificates.crt "$system/try/certificates.crt"
cat >"$system/try/run" <<'END'
set -eu
cd /try
. /etc/os-release
echo "$PRETTY_NAME, $(python3 -V), $(ldd --version | sed -n '1s/.* /glibc /p')"
for tool in cc c++ gcc g++ clang cmake make ninja; do
  ! command -v $tool || { echo "this system is not bare: it has $tool" >&2; exit 1; }
done
now() { date +%s; }
begin=$(now)
python3 -m venv sms
echo "environment       $(($(now) - begin)) s"
step=$(now)
sms/bin/pip install --quiet --disable-pip-version-check --no-cache-dir --no-compile --only-binary :all: --find-links . sms
echo "pip install sms   $(($(now) - step)) s"
step=$(now)
if ! sms/bin/sms demo --out demo >demo.txt 2>&1; then cat demo.txt >&2; exit 1; fi
echo "sms demo          $(($(now) - step)) s"
sms/bin/python -c 'from sms import _core; print("core" + " " * 14 + ("with" if _core.uses_avx2() else "without"), "AVX2")'
cat demo.txt
echo "from nothing to a verdict: $(($(now) - begin)) s"
END
# shellcheck disable=SC2016  # the inner shell's
# Mounts of its own, which end with it.
unshare --mount sh -c '
  mount -t proc proc "$1/proc" && mount --rbind /dev "$1/dev" &&
    exec chroot "$1" env -i HOME=/try PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 PIP_CERT=/try/certificates.crt \
      ${SMS_AVX2+SMS_AVX2="$SMS_AVX2"} sh /try/run' sh "$system"
