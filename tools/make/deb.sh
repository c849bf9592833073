#!/bin/sh
# Packs what `make install` lays out: deb.sh FOLDER PACKAGE.deb VERSION MAKE. Needs dpkg-dev (build-essential has it).
set -eu
folder=$1
package=$2
version=$3
make=$4
control=firmware/deploy/debian
root=$folder/root
rm -rf "$folder"
mkdir -p "$root/DEBIAN" "$folder/debian"
$make install DESTDIR="$(realpath "$root")" PREFIX=/usr SYSCONFDIR=/etc > "$folder/install.log"
find "$root/usr/bin" -type f -exec strip --strip-unneeded {} +
install -D -m 644 LICENSE "$root/usr/share/doc/ale-slam/copyright"

# dpkg-shlibdeps wants to find itself in a source package.
printf 'Source: ale-slam\n\nPackage: ale-slam\nArchitecture: any\nDescription: -\n' > "$folder/debian/control"
programs=$(cd "$folder" && find root/usr/bin -type f)
depends=$(cd "$folder" && dpkg-shlibdeps -O $programs 2> shlibdeps.log | sed 's/^shlibs:Depends=//')
sed -e "s/@VERSION@/$version/" -e "s/@ARCHITECTURE@/$(dpkg --print-architecture)/" -e "s/@DEPENDS@/$depends/" \
    -e "s/@SIZE@/$(du -sk "$root" | cut -f1)/" "$control/control.in" > "$root/DEBIAN/control"
install -m 644 "$control/conffiles" "$root/DEBIAN"
install -m 755 "$control/postinst" "$control/prerm" "$control/postrm" "$root/DEBIAN"
dpkg-deb --root-owner-group --build "$root" "$package" > /dev/null
echo "$package"
