#!/bin/sh
# Builds ctl_loop, runs a .hal file with it, and leaves the machine as it was:
#
#     sh controller-capi/hal/run.sh                  # loop.hal: two loops beside each other
#     sh controller-capi/hal/run.sh my.hal
#
# HAL loads modules from its own folder only. Whoever may write there (the superuser) gets the module put there for the time
# of the run; anybody else installs it first: sudo make -C controller-capi/hal install
#
# ARCHIVE, BUILD: as in the Makefile. SECONDS_AT_MOST: the run ends then, by force; 60.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
file=$(realpath "${1:-$here/loop.hal}")
modules=${RTLIBDIR:-/usr/lib/linuxcnc/modules}
realtime=/usr/lib/linuxcnc/realtime
build=${BUILD:-$here/../../target/hal}

for tool in halrun halcompile make; do
    command -v "$tool" >/dev/null || {
        echo "$tool is missing: apt-get install linuxcnc-uspace linuxcnc-uspace-dev make" >&2
        exit 69
    }
done
if "$realtime" status >/dev/null 2>&1; then
    echo "HAL runs on this machine already; this is not started beside it" >&2
    exit 75
fi
make -s -C "$here" BUILD="$build" ${ARCHIVE:+ARCHIVE="$ARCHIVE"} >&2

work=$(mktemp -d)
started=
put=
restore() {
    trap - EXIT INT TERM
    if [ -n "$started" ]; then
        # What a run that was ended by force has left behind.
        if "$realtime" status >/dev/null 2>&1; then
            timeout -k 5 20 halrun -U >/dev/null 2>&1 || true
        fi
    fi
    if [ -n "$put" ]; then
        rm -f "$modules/ctl_loop.so"
        [ ! -e "$work/before.so" ] || cp -p "$work/before.so" "$modules/ctl_loop.so"
    fi
    rm -rf "$work"
}
trap restore EXIT
trap 'exit 130' INT TERM

if [ -w "$modules" ]; then
    [ ! -e "$modules/ctl_loop.so" ] || cp -p "$modules/ctl_loop.so" "$work/before.so"
    put=yes
    cp "$build/ctl_loop.so" "$modules/ctl_loop.so"
elif ! cmp -s "$build/ctl_loop.so" "$modules/ctl_loop.so"; then
    echo "ctl_loop is not installed as it is built here; run: sudo make -C $here install" >&2
    exit 77
fi

# HAL's realtime program does not run as the superuser: it is told whom to be, and where that one may open its socket.
chmod 711 "$work"
mkdir -m 1777 "$work/socket"
export RTAPI_FIFO_PATH="$work/socket/rtapi"
if [ "$(id -u)" = 0 ]; then
    export RTAPI_UID="${RTAPI_UID:-65534}"
fi
started=yes
code=0
timeout -k 5 "${SECONDS_AT_MOST:-60}" halrun -f "$file" </dev/null || code=$?
[ "$code" != 124 ] || echo "ended by force after ${SECONDS_AT_MOST:-60} s" >&2
exit "$code"
