#include "sweep/workers/worker.hpp"

#include "sweep/store/artefacts.hpp"
#include "sweep/workers/compute.hpp"
#include "sweep/workers/message.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace grainsweep::workers {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

/// What the boss said, read on a thread of its own so that an end of file is noticed in the middle of a
/// case. When the boss is gone nobody can use an answer: the process ends at once.
class Ear {
public:
    explicit Ear(double lease_seconds) : lease_(lease_seconds) {
        std::thread([this] { listen(); }).detach();
        std::thread([this] { mind_the_lease(); }).detach();
    }

    /// The next question; nothing once the boss said stop.
    std::optional<Run> next() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return stop_ || !questions_.empty(); });
        if (stop_) return std::nullopt;
        Run run = std::move(questions_.front());
        questions_.pop_front();
        return run;
    }

    bool stopped() const { return stop_; }

    std::deque<Run> unanswered() {
        const std::lock_guard lock(mutex_);
        return std::exchange(questions_, {});
    }

private:
    void listen() {
        std::string line;
        while (std::getline(std::cin, line)) {
            silence_ = 0;
            ToWorker message = decode_to_worker(line);
            const std::lock_guard lock(mutex_);
            if (auto* run = std::get_if<Run>(&message)) questions_.push_back(std::move(*run));
            if (std::holds_alternative<Stop>(message)) stop_ = true;
            changed_.notify_all();
        }
        std::_Exit(3);
    }

    // Counts its own seconds and looks at no clock: a process that is stopped (Ctrl-Z, a suspended machine) was not
    // awake to hear its boss, who was stopped with it.
    void mind_the_lease() {
        while (true) {
            std::this_thread::sleep_for(1s);
            if (++silence_ > lease_) std::_Exit(3);
        }
    }

    double lease_;
    std::atomic<int> silence_ = 0;  // seconds
    std::atomic<bool> stop_ = false;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Run> questions_;
};

void say(const ToBoss& message) {
    const std::string line = encode(message) + "\n";
    std::fwrite(line.data(), 1, line.size(), stdout);
    std::fflush(stdout);
}

/// Shared starting states, kept apart by build and instruction path: another one rounds differently, and a state found
/// must be to the last bit the one that would be computed.
class OwnArtefacts final : public Artefacts {
public:
    OwnArtefacts(store::ArtefactFolder* folder, const std::string& version)
        : folder_(folder), suffix_(fmt::format("\nversion={}\npath={}\n", version, instruction_path())) {}
    [[nodiscard]] std::optional<Bytes> get(std::string_view key) override {
        return folder_ != nullptr ? folder_->get(std::string(key) + suffix_) : std::nullopt;
    }
    void put(std::string_view key, std::span<const std::byte> contents) override {
        if (folder_ != nullptr) folder_->put(std::string(key) + suffix_, contents);
    }

private:
    store::ArtefactFolder* folder_;
    std::string suffix_;
};

/// Saves and finds the state of an unfinished case. The file is named by the case and the build, not by the
/// attempt: every attempt follows the same path bit for bit, so any attempt may continue any other's.
class Checkpoints {
public:
    Checkpoints(store::ArtefactFolder* folder, const campaign::CaseId& id, const std::string& version)
        : folder_(folder), key_(checkpoint_key(id, version)) {}

    std::optional<Bytes> load() {
        auto bytes = folder_ ? folder_->get(key_) : std::nullopt;
        exists_ = bytes.has_value();
        return bytes;
    }
    void save(const Scene& scene) {
        if (!folder_) return;
        Bytes bytes;
        scene.save(bytes);
        folder_->put(key_, bytes);
        exists_ = true;
    }
    bool exists() const { return exists_; }

private:
    store::ArtefactFolder* folder_;
    std::string key_;
    bool exists_ = false;
};

/// Looks in on a running case: beats, saves, and gives it up after a stop.
class Watchman {
public:
    Watchman(const Run& run, const WorkerOptions& options, const Ear& ear, Checkpoints& checkpoints)
        : attempt_{run.question.id, run.attempt}, options_(options), ear_(ear), checkpoints_(checkpoints) {}

    bool operator()(const Scene& scene) {
        const auto now = Clock::now();
        if (now - beat_ > 1s) {
            say(Alive{attempt_, scene.progress()});
            beat_ = now;
        }
        if (seconds(now - saved_) > options_.checkpoint_seconds) {
            checkpoints_.save(scene);
            saved_ = Clock::now();
        }
        if (!ear_.stopped()) return true;
        if (!stop_seen_) stop_seen_ = now;
        if (seconds(now - *stop_seen_) < options_.park_seconds) return true;
        checkpoints_.save(scene);
        return false;
    }

private:
    static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

    campaign::Attempt attempt_;
    const WorkerOptions& options_;
    const Ear& ear_;
    Checkpoints& checkpoints_;
    Clock::time_point beat_ = Clock::now();
    Clock::time_point saved_ = Clock::now();
    std::optional<Clock::time_point> stop_seen_;
};

void answer(const Run& run, const WorkerOptions& options, store::ArtefactFolder* folder, Ear& ear) {
    OwnArtefacts artefacts(folder, options.version);
    Checkpoints checkpoints(folder, run.question.id, options.version);
    // Looking for a checkpoint costs a failed open; only a case tried before can have one.
    const auto resume = run.attempt > 1 ? checkpoints.load() : std::nullopt;
    Watchman watchman(run, options, ear, checkpoints);
    auto result = compute(run.question, run.attempt, artefacts, resume, std::ref(watchman));
    if (result) {
        say(Done{std::move(*result), checkpoints.exists()});
    } else {
        say(Parked{{run.question.id, run.attempt}});
    }
}

}  // namespace

std::string checkpoint_key(const campaign::CaseId& id, const std::string& version) {
    return fmt::format("checkpoint\ncase={}\nversion={}\npath={}\n", id, version, instruction_path());
}

int work(const WorkerOptions& options) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a local boss; a remote one is noticed by end of file and lease
    std::signal(SIGINT, SIG_IGN);        // Ctrl-C is the boss's to interpret
    std::ios::sync_with_stdio(false);
    std::optional<store::ArtefactFolder> folder;
    if (!options.artefacts.empty()) folder.emplace(options.artefacts);

    say(Ready{options.version, std::string(instruction_path())});
    static Ear* ear = new Ear(options.lease_seconds);  // outlives main: its threads are never joined
    while (const auto run = ear->next()) answer(*run, options, folder ? &*folder : nullptr, *ear);
    for (const auto& run : ear->unanswered()) say(Parked{{run.question.id, run.attempt}});
    std::fflush(stdout);
    std::_Exit(0);
}

}  // namespace grainsweep::workers
