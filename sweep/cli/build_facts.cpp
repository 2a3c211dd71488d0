#include "sweep/cli/build_facts.hpp"

#include "solver/scenes/scene.hpp"

#include <grainsweep_version.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <fstream>

namespace grainsweep::cli {

namespace {

/// "model name" of the first processor, as the kernel tells it.
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

}  // namespace

std::string program_version() {
    return GRAINSWEEP_VERSION;
}

std::string build_version() {
    return fmt::format("{} ({})", GRAINSWEEP_VERSION, GRAINSWEEP_COMMIT);
}

store::Provenance provenance() {
    return {
        GRAINSWEEP_VERSION, GRAINSWEEP_COMMIT, GRAINSWEEP_COMPILER, GRAINSWEEP_FLAGS, std::string(instruction_path()),
        processor_name(),   host_name()};
}

std::string version_text() {
    return fmt::format("grainsweep {}\ncommit {}\ncompiler {}\nflags {}\ninstruction path {}", GRAINSWEEP_VERSION,
                       GRAINSWEEP_COMMIT, GRAINSWEEP_COMPILER, GRAINSWEEP_FLAGS, instruction_path());
}

}  // namespace grainsweep::cli
