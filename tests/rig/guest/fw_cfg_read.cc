// SPDX-License-Identifier: Apache-2.0
// fw_cfg_read NAME: prints one fw_cfg file of QEMU, in one pass over the data port, without
// interrupts. The kernel's own sysfs file seeks byte by byte for every page it reads: 3 MB take
// minutes.
//
//     port 0x510  selector, 16 bit little-endian; 0x19 is the directory
//     port 0x511  data, 8 bit, the selected item byte after byte
//     directory   big-endian u32 count, then {u32 size, u16 selector, u16 reserved, char name[56]}
//
// Source: QEMU, docs/specs/fw_cfg.rst.
#include <sys/io.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace {

constexpr std::uint16_t kSelectorPort = 0x510, kDataPort = 0x511, kDirectory = 0x19;

std::uint32_t read_big_endian(int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | inb(kDataPort);
  return value;
}

struct Item {
  std::uint32_t size = 0;
  std::uint16_t selector = 0;
};

bool find(const char* wanted, Item& found) {
  outw(kDirectory, kSelectorPort);
  const std::uint32_t count = read_big_endian(4);
  for (std::uint32_t i = 0; i < count; ++i) {
    Item item;
    item.size = read_big_endian(4);
    item.selector = static_cast<std::uint16_t>(read_big_endian(2));
    read_big_endian(2);
    std::array<char, 57> name{};
    for (std::size_t letter = 0; letter < 56; ++letter)
      name[letter] = static_cast<char>(inb(kDataPort));
    if (std::strcmp(name.data(), wanted) == 0) {
      found = item;
      return true;
    }
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  Item item;
  if (argc != 2 || iopl(3) != 0 || !find(argv[1], item)) {
    std::fprintf(stderr, "fw_cfg_read: no such file, or no right to read ports\n");
    return 1;
  }
  outw(item.selector, kSelectorPort);
  std::array<unsigned char, 4096> block{};
  for (std::uint32_t done = 0; done < item.size;) {
    const std::size_t now = item.size - done < block.size() ? item.size - done : block.size();
    insb(kDataPort, block.data(), static_cast<unsigned long>(now));
    if (std::fwrite(block.data(), 1, now, stdout) != now) return 1;
    done += static_cast<std::uint32_t>(now);
  }
  return std::fflush(stdout) == 0 ? 0 : 1;
}
