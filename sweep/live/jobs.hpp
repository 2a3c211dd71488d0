// Work that a page asks for, each in a process of its own at low priority: a film, an answer to SQL. They end with this
// object.
#pragma once

#include "sweep/files/descriptor.hpp"

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::live {

class Jobs {
public:
    Jobs() = default;
    Jobs(const Jobs&) = delete;
    Jobs& operator=(const Jobs&) = delete;
    ~Jobs();

    /// What one job may take.
    struct Bounds {
        std::size_t most_at_once = 4;  ///< it does not start beside so many
        std::int64_t most_bytes = 0;   ///< of a file that it writes
    };
    /// Runs this program with these arguments; its number, or nothing where enough are running or none can be started.
    [[nodiscard]] std::optional<std::int64_t> start(const std::vector<std::string>& arguments,
                                                    const std::filesystem::path& folder, const Bounds& bounds);
    struct Ended {
        int code = 0;
        std::string out, err;
    };
    struct State {
        bool known = false;
        std::optional<Ended> ended;
    };
    /// A job that has ended is forgotten by the call that says so.
    [[nodiscard]] State look_at(std::int64_t number);

private:
    struct Job {
        pid_t process = 0;
        files::Descriptor out, err;
        std::optional<int> code = {};  ///< once it has ended
        /// Whether it still runs.
        [[nodiscard]] bool goes_on();
    };
    static constexpr std::size_t most_kept = 16;  ///< ended jobs whose reader does not come
    std::map<std::int64_t, Job> jobs_;
    std::int64_t last_ = 0;
};

/// A run that a page started. It goes on when this object ends, as one from a shell would.
class Runner {
public:
    /// Standard output and error go to x.run.log beside the database x.db. False where it cannot be started.
    [[nodiscard]] bool start(const std::vector<std::string>& arguments, const std::filesystem::path& database);
    [[nodiscard]] bool running();

private:
    std::optional<pid_t> process_;
};

}  // namespace grainsweep::live
