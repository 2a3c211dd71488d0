#include "sweep/files/beside_program.hpp"

#include <system_error>

namespace grainsweep::files {

std::filesystem::path beside_program(std::string_view name) {
    std::error_code none;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", none);
    return program.parent_path().parent_path() / "share/grainsweep" / name;
}

}  // namespace grainsweep::files
