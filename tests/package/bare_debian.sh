#!/usr/bin/env bash
# Installs the Debian package by apt into a bare Debian 12, uses what it brings, and purges it: the system's files are what they were.
# By hand, as root: it downloads a system (debootstrap) and the package's dependencies.
#   tests/package/bare_debian.sh PACKAGE.deb ROOT_FOLDER [MIRROR]
# The folder is kept; a second run begins with the system that is there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
deb=$(realpath "$1")
root=$(realpath -m "$2")
mirror=${3:-http://deb.debian.org/debian}
if [ ! -x "$root/usr/bin/apt-get" ]; then
  command -v debootstrap >/dev/null || { echo "debootstrap isn't installed"; exit 77; }
  debootstrap --variant=minbase --include=ca-certificates bookworm "$root" "$mirror"
fi
undo() { umount "$root/proc" "$root/dev" 2>/dev/null || true; }
trap undo EXIT
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"
mountpoint -q "$root/dev" || mount --bind /dev "$root/dev"
rm -rf "$root/root/consumer" "$root"/root/*.sgm "$root"/root/t.*
cp "$deb" "$root/root/sgm.deb"
cp -r "$here/consumer" "$root/root/consumer"

inside() { chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive bash -euo pipefail -c "$1"; }
install="apt-get install -y -q --no-install-recommends"
# What a package manager notes of itself, and caches, which other packages' triggers write.
files() {
  (cd "$root" && find . -xdev \( -path ./proc -o -path ./dev -o -path ./sys -o -path ./run -o -path ./tmp -o -path ./root -o -path ./var/log \
    -o -path ./var/cache -o -path ./var/lib/dpkg -o -path ./var/lib/apt \) -prune -o -type f -printf '%p %s\n' | LC_ALL=C sort)
}

inside "apt-get update -q >/dev/null && $install bash-completion zsh fish man-db shared-mime-info xvfb xauth libgl1-mesa-dri libegl1 cmake g++ make desktop-file-utils >/dev/null"
inside "$install /root/sgm.deb >/dev/null && apt-get purge -y -q sgm >/dev/null"  # its dependencies stay
files >"$root.before"
inside "$install /root/sgm.deb >/dev/null && dpkg -s sgm | grep -E '^(Status|Version|Installed-Size)'"

inside 'cd /root && sgm examples tower >/dev/null && sgm check tower.sgm && sgm build tower.sgm --resolution 64 -q -o t.glb -o t.vdb -o t.html && ls -l t.* && sgm new house && sgm check house.sgm'
inside 'cd /root && sgm render tower.sgm --size 64x64 -q -o t.png && test -s t.png'
echo "sgm: builds meshes, volumes, pages, pictures"
inside 'cd /root && sgm-viewer --version && ended=0 && { timeout 25 xvfb-run -a sgm-viewer tower.sgm || ended=$?; } && [ $ended = 124 ]'
echo "sgm-viewer: its window stands until it is closed"
inside 'cd /root/consumer && cmake -B build >/dev/null && cmake --build build >/dev/null && cd build && ./consumer && test -s ten.glb'
echo "find_package(sgm): a program of ten lines writes a mesh"
inside '. /usr/share/bash-completion/bash_completion && { _completion_loader sgm || [ $? = 124 ]; }; COMP_WORDS=(sgm bui) COMP_CWORD=1; _sgm sgm bui sgm; [ "${COMPREPLY[*]}" = build ]'
inside 'fish -c "complete -C \"sgm bui\"" | grep -q ^build'
inside 'zsh -fc "autoload -Uz compinit && compinit -u -d /tmp/zcompdump && [ \${_comps[sgm]} = _sgm ]"'
echo "completions: bash, fish and zsh know sgm"
inside 'man -w sgm sgm-viewer && desktop-file-validate /usr/share/applications/sgm-viewer.desktop && grep -q "text/x-sgm:\*.sgm" /usr/share/mime/globs'
echo "manual pages, menu and the type of .sgm files are there"

inside 'rm -rf /root/consumer /root/*.sgm /root/t.* /tmp/zcompdump && apt-get purge -y -q sgm >/dev/null'
files >"$root.after"
diff "$root.before" "$root.after" || { echo "the system isn't what it was"; exit 1; }
left=$(inside 'find / -xdev \( -path /proc -o -path /root -o -path /var/log -o -path /var/cache \) -prune -o \( -name "*sgm*" -not -path "/usr/share/mime/*" -not -path "/usr/lib/python3*" \) -print' | grep -v "linux/.*sgm\|sgml" || true)
[ -z "$left" ] || { echo "left: $left"; exit 1; }
inside '! grep -rqs "x-sgm" /usr/share/mime /usr/share/applications'
echo "purged: the system's files are what they were"
