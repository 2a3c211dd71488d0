#include "sweep/cli/threads_option.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/workers/job_cores.hpp"

namespace grainsweep::cli {

void declare_threads(Parser& parser, std::int64_t& count) {
    parser
        .add_option("--threads N", count,
                    "threads for the case; 0, the default: one per core of the job; results do not depend on it")
        ->check(whole_number(0, 1024));
}

void use_threads(std::int64_t count) {
    allow_threads(static_cast<int>(count > 0 ? count : static_cast<std::int64_t>(workers::job_cores())));
}

}  // namespace grainsweep::cli
