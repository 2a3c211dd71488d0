#include "sweep/cli/threads_option.hpp"

namespace grainsweep::cli {

void declare_threads(Parser& parser, std::int64_t& count) {
    parser
        .add_option("--threads", count,
                    "threads that compute the case, which changes no bit of it; 0, the default: one for each core")
        ->check(whole_number(0, 1024));
}

}  // namespace grainsweep::cli
