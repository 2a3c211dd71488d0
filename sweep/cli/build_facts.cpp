#include "sweep/cli/build_facts.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/files/whole_file.hpp"

#include <grainsweep_version.hpp>

#include <elf.h>
#include <fmt/format.h>
#include <link.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <fstream>

namespace grainsweep::cli {

namespace {

/// "model name" of the first processor, as the kernel reports it.
std::string processor_name() {
    std::ifstream cpuinfo("/proc/cpuinfo");
    std::string line;
    while (std::getline(cpuinfo, line)) {
        const auto colon = line.find(": ");
        if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

std::string host_name() {
    std::array<char, 256> name{};
    return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// The bytes of a note that the linker made of the whole executable, in hexadecimal; empty: no such note in `segment`.
std::string build_id_in(const std::byte* segment, std::size_t size) {
    constexpr auto padded = [](std::size_t length) { return (length + 3) / 4 * 4; };
    ElfW(Nhdr) note{};
    while (size >= sizeof note) {
        std::memcpy(&note, segment, sizeof note);
        const std::size_t name = sizeof note, contents = name + padded(note.n_namesz);
        const std::size_t length = contents + padded(note.n_descsz);
        if (length > size) break;
        if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == 4 && std::memcmp(segment + name, "GNU", 4) == 0) {
            std::string text;
            for (std::size_t k = 0; k < note.n_descsz; ++k)
                text += fmt::format("{:02x}", std::to_integer<unsigned>(segment[contents + k]));
            return text;
        }
        segment += length;
        size -= length;
    }
    return {};
}

/// Called for the executable first, whose name is empty, then for every library.
int look_for_build_id(dl_phdr_info* object, std::size_t, void* found) {
    for (int k = 0; k < object->dlpi_phnum; ++k) {
        const auto& header = object->dlpi_phdr[k];
        if (header.p_type != PT_NOTE) continue;
        const auto* segment = reinterpret_cast<const std::byte*>(object->dlpi_addr + header.p_vaddr);
        auto& text = *static_cast<std::string*>(found);
        if (text = build_id_in(segment, header.p_memsz); !text.empty()) break;
    }
    return 1;  // the executable only
}

}  // namespace

std::string program_version() {
    return GRAINSWEEP_VERSION;
}

std::string build_version() {
    return fmt::format("{} ({})", GRAINSWEEP_VERSION, GRAINSWEEP_COMMIT);
}

std::string build_id() {
    std::string text;
    ::dl_iterate_phdr(look_for_build_id, &text);
    if (!text.empty()) return text;
    std::error_code ignored;
    return campaign::content_hash(files::whole_file("/proc/self/exe", ignored));  // a linker that leaves no such note
}

campaign::Computer this_computer() {
    return {GRAINSWEEP_VERSION, GRAINSWEEP_COMMIT, build_id(), std::string(instruction_path()),
            processor_name(),   host_name()};
}

store::Provenance provenance() {
    return {
        GRAINSWEEP_VERSION, GRAINSWEEP_COMMIT, GRAINSWEEP_COMPILER, GRAINSWEEP_FLAGS, std::string(instruction_path()),
        processor_name(),   host_name()};
}

std::string version_text() {
    return fmt::format("grainsweep {}\ncommit {}\nbuild {}\ncompiler {}\nflags {}\ninstruction path {}",
                       GRAINSWEEP_VERSION, GRAINSWEEP_COMMIT, build_id(), GRAINSWEEP_COMPILER, GRAINSWEEP_FLAGS,
                       instruction_path());
}

}  // namespace grainsweep::cli
