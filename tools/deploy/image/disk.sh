# SPDX-License-Identifier: Apache-2.0
# disk.sh - sourced by tools/image: a disk with a GPT of three partitions, without a loop device.
# shellcheck shell=bash disable=SC2154  # work, uuid are of tools/image
#
#   1  1 MiB   GRUB for a BIOS       2  64 MiB  EFI system, removable path       3  root, ext4
BIOS_SECTOR=2048 EFI_SECTOR=4096 ROOT_SECTOR=135168 SECTOR=512
FREE_KB=$((600 * 1024))

# make_disk FOLDER FILE
make_disk() {
  local pc=$1 disk=$2 root_kb
  grub_config "$pc"
  root_kb=$(($(du -sk --one-file-system "$pc" | cut -f1) + FREE_KB))
  truncate -s $((ROOT_SECTOR * SECTOR + root_kb * 1024 + 1048576)) "$disk"
  sfdisk --quiet "$disk" <<EOT
label: gpt
start=$BIOS_SECTOR, size=2048, type=21686148-6449-6E6F-744E-656564454649, name=bios
start=$EFI_SECTOR, size=131072, type=C12A7328-F81F-11D2-BA4B-00A0C93EC93B, name=efi
start=$ROOT_SECTOR, size=$((root_kb * 2)), type=4F68BCE3-E8CD-4DB1-96E7-FBCAF984B709, name=root
EOT
  bios_boot "$pc" "$disk"
  efi_boot "$pc" "$disk"
  # Features that GRUB 2.06 cannot read are off.
  mke2fs -q -t ext4 -O ^metadata_csum_seed,^orphan_file -U "$uuid" -L tact -d "$pc" \
    -E offset=$((ROOT_SECTOR * SECTOR)) "$disk" "${root_kb}k"
}

# The menu until update-grub writes its own on the PC, with the same parameters.
grub_config() {
  local pc=$1 parameters kernel
  parameters=$(inside 'set +u; . /etc/default/grub; for file in /etc/default/grub.d/*.cfg; do . $file; done
    echo "$GRUB_CMDLINE_LINUX $GRUB_CMDLINE_LINUX_DEFAULT"')
  kernel=$(basename "$(echo "$pc"/boot/vmlinuz-*-rt-*)")
  mkdir -p "$pc/boot/grub/x86_64-efi" "$pc/boot/grub/i386-pc"
  cp "$pc"/usr/lib/grub/x86_64-efi/*.{mod,lst} "$pc/boot/grub/x86_64-efi"
  cp "$pc"/usr/lib/grub/i386-pc/*.{mod,lst} "$pc/boot/grub/i386-pc"
  cat >"$pc/boot/grub/grub.cfg" <<EOT
set timeout=1
menuentry tact {
  search --no-floppy --fs-uuid --set=root $uuid
  linux /boot/$kernel root=UUID=$uuid ro $parameters
  initrd /boot/${kernel/vmlinuz/initrd.img}
}
EOT
  cat >"$work/early.cfg" <<EOT
search.fs_uuid $uuid root
set prefix=(\$root)/boot/grub
configfile \$prefix/grub.cfg
EOT
}

# poke FILE OFFSET BYTES: hexadecimal bytes at an offset
poke() { printf "$(sed 's/../\\x&/g' <<<"$3")" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none; }
# little NUMBER BYTES: in hexadecimal, the lowest byte first
little() { printf "%0$((2 * $2))x" "$1" | fold -w2 | tac | tr -d '\n'; }

# As grub-bios-setup, which asks for a block device. Offsets: GRUB's include/grub/i386/pc/boot.h, the
# sector of the core image and the test for a wrong drive number; its list of blocks is the last
# twelve bytes of its first sector.
bios_boot() {
  local pc=$1 disk=$2 core="$1/boot/grub/core.img"
  cp "$work/early.cfg" "$pc/boot/grub/early.cfg"
  inside 'grub-mkimage -O i386-pc -o /boot/grub/core.img -c /boot/grub/early.cfg -p /boot/grub \
    biosdisk part_gpt ext2 search search_fs_uuid normal configfile linux'
  cp "$pc/usr/lib/grub/i386-pc/boot.img" "$work/boot.img"
  poke "$work/boot.img" $((0x5c)) "$(little $BIOS_SECTOR 8)"
  poke "$work/boot.img" $((0x66)) 9090
  poke "$core" $((0x1f4)) "$(little $((BIOS_SECTOR + 1)) 8)"
  [ "$(stat -c %s "$core")" -le $((2048 * SECTOR)) ]
  dd if="$work/boot.img" of="$disk" bs=440 count=1 conv=notrunc status=none
  dd if="$core" of="$disk" bs=$SECTOR seek=$BIOS_SECTOR conv=notrunc status=none
  rm "$core" "$pc/boot/grub/early.cfg"
}

# Debian's signed loaders, so that Secure Boot may stay on.
efi_boot() {
  local pc=$1 disk=$2 efi="$work/efi"
  truncate -s $((64 * 1048576)) "$efi"
  mkfs.fat -F 32 -s 1 -n EFI "$efi"
  mmd -i "$efi" ::/EFI ::/EFI/BOOT ::/EFI/debian
  mcopy -i "$efi" "$pc/usr/lib/shim/shimx64.efi.signed" ::/EFI/BOOT/BOOTX64.EFI
  mcopy -i "$efi" "$pc/usr/lib/shim/mmx64.efi.signed" ::/EFI/BOOT/mmx64.efi
  mcopy -i "$efi" "$pc/usr/lib/grub/x86_64-efi-signed/grubx64.efi.signed" ::/EFI/BOOT/grubx64.efi
  mcopy -i "$efi" "$work/early.cfg" ::/EFI/debian/grub.cfg
  dd if="$efi" of="$disk" bs=$SECTOR seek=$EFI_SECTOR conv=notrunc,sparse status=none
}
