// Worker processes of this same executable, kept for the whole campaign. The only file that knows
// Boost.Process; it launches, listens and stops, and decides nothing.
#pragma once

#include "sweep/workers/crew.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace grainsweep::workers {

struct PoolOptions {
    std::vector<std::string> command;  ///< launcher prefix, executable, "worker", its arguments
    std::size_t workers = 1;
    double wall_seconds = 0;  ///< limit of one case, from when its worker is ready for it; 0: none
    std::string version;      ///< what a worker's Ready must say
};

class Pool final : public Crew {
public:
    /// Launches lazily: a worker starts with the first case it is given, and again after one was lost; start() throws
    /// std::runtime_error where the command cannot be started at all.
    explicit Pool(PoolOptions options);
    /// Whether there is such a program, on the search path where the word is no path.
    [[nodiscard]] static bool can_start(const std::string& program);
    ~Pool() override;

    [[nodiscard]] bool has_room(double predicted_seconds) const override;
    void start(const campaign::Attempt& attempt, const campaign::Case& question) override;
    [[nodiscard]] std::optional<PoolEvent> wait(std::chrono::milliseconds at_most) override;
    [[nodiscard]] std::size_t outstanding() const override;
    void retire() override;
    void dismiss() override;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainsweep::workers
