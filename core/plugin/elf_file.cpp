// SPDX-License-Identifier: Apache-2.0
#include "hone/core/plugin/elf_file.h"

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <vector>

#include <elf.h>
#include <link.h>

namespace hone {
namespace {

using Header = ElfW(Ehdr);
using Segment = ElfW(Phdr);

#if defined(__x86_64__)
constexpr auto kMachine = EM_X86_64;
#elif defined(__aarch64__)
constexpr auto kMachine = EM_AARCH64;
#elif defined(__riscv)
constexpr auto kMachine = EM_RISCV;
#else
constexpr auto kMachine = EM_NONE; // unknown here: left to dlopen
#endif

/// What files of this machine begin with: magic, class, byte order.
constexpr unsigned char kClass = sizeof(void*) == 8 ? ELFCLASS64 : ELFCLASS32;
constexpr unsigned char kOrder =
    std::endian::native == std::endian::little ? ELFDATA2LSB : ELFDATA2MSB;

constexpr const char* kNotALibrary = "it is not a shared library (ELF)";

} // namespace

std::string whyNotLoadable(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        return std::string("it cannot be read: ") + std::strerror(errno);
    const std::uint64_t bytes = std::filesystem::file_size(file);
    const std::string truncated =
        "it is truncated: it has " + std::to_string(bytes) + " bytes, fewer than it says";

    Header header{};
    stream.read(reinterpret_cast<char*>(&header), sizeof header);
    if (stream.gcount() < SELFMAG || std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
        return kNotALibrary;
    if (stream.gcount() < static_cast<std::streamsize>(sizeof header))
        return truncated;
    if (header.e_ident[EI_CLASS] != kClass || header.e_ident[EI_DATA] != kOrder ||
        (kMachine != EM_NONE && header.e_machine != kMachine))
        return "it was built for another architecture";
    if (header.e_type != ET_DYN)
        return kNotALibrary;

    // Everything that is mapped must be there.
    if (header.e_phentsize != sizeof(Segment))
        return kNotALibrary;
    std::vector<Segment> segments(header.e_phnum);
    const auto table_bytes = static_cast<std::streamsize>(segments.size() * sizeof(Segment));
    if (header.e_phoff > bytes)
        return truncated;
    stream.seekg(static_cast<std::streamoff>(header.e_phoff));
    stream.read(reinterpret_cast<char*>(segments.data()), table_bytes);
    if (stream.gcount() < table_bytes)
        return truncated;
    for (const Segment& segment : segments)
        if (segment.p_offset > bytes || segment.p_filesz > bytes - segment.p_offset)
            return truncated;
    return "";
}

} // namespace hone
