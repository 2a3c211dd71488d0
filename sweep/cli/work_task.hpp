// `work`: one task of a campaign without a main program, with all parts connected.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

struct WorkRequest {
    std::filesystem::path config, spool;
    std::string share;                    ///< "i/n"; empty: from the Slurm array, or 1/1
    std::optional<std::int64_t> workers;  ///< overrides the campaign file; 0: all cores
    double lease = 300;
    bool quiet = false;
    std::string path;  ///< instruction path of the workers; empty: the widest of each
};

struct WorkReport {
    int exit_code = 0;
    std::string campaign;
    std::int64_t part = 1, of = 1;
    std::int64_t cases = 0, answered = 0, computed = 0;
    std::string ending;  ///< one sentence
};

/// Runs the task. Throws WrongQuestion for a campaign whose points depend on answers.
[[nodiscard]] WorkReport work_on(const WorkRequest& request);

}  // namespace grainsweep::cli
