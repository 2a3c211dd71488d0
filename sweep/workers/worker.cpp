#include "sweep/workers/worker.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/files/descriptor.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/workers/asking_signals.hpp"
#include "sweep/workers/line_buffer.hpp"
#include "sweep/workers/message.hpp"
#include "sweep/workers/program_answerer.hpp"
#include "sweep/workers/staged_campaign.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

namespace grainsweep::workers {
namespace {

using Clock = std::chrono::steady_clock;

// ---- desk ------------------------------------------------------------------------------------------------------

/// Reason why a worker must end.
enum class Ending {
    none,
    asked,    ///< the main program wrote stop
    signal,   ///< a signal that requests the end of a process
    silence,  ///< no message from the main program for too long
};

constexpr int main_program_is_gone = 3;
constexpr int nonsense_was_written = 2;

/// Ends the worker after an invalid message, because its answers might belong to other cases than the requested ones.
[[noreturn]] void refuse(std::string_view line, std::string_view why) {
    const std::string sentence = fmt::format("grainsweep worker: standard input is not the main program's: {} ({})\n",
                                             shortened(line, 200), why);
    (void)std::fwrite(sentence.data(), 1, sentence.size(), stderr);
    std::_Exit(nonsense_was_written);
}

/// Messages between a worker and its main program: cases come in; heartbeats, answers and returned cases go out.
/// Reading, signals and the clock have threads of their own, so that they are served while a case is computed.
///
/// The thread that computes makes the desk. It blocks the signals that it waits for, so make it before any other thread
/// starts.
class MainConnection {
public:
    struct Limits {
        double lease_seconds = 600;
        double give_back_seconds = 20;
    };
    explicit MainConnection(const Limits& limits)
        : limits_(limits), progress_(std::numeric_limits<double>::quiet_NaN()) {
        hold_asking_signals();
        ::pthread_getcpuclockid(::pthread_self(), &computing_);
    }
    MainConnection(const MainConnection&) = delete;
    MainConnection& operator=(const MainConnection&) = delete;

    /// Sends that the worker is ready, and starts to read.
    void open(const campaign::Computer& computer) {
        {
            const std::lock_guard lock(mutex_);
            write(Ready{protocol_number, computer});
            flush();
        }
        std::thread([this] { read(); }).detach();
        std::thread([this] {
            const auto asked = [this](int signal) {
                end(Ending::signal,
                    fmt::format("its worker was asked to end by signal {} ({})", signal, ::strsignal(signal)));
            };
            attend(asked, [this] { tick(); });
        }).detach();
    }
    /// Returns the next case; empty once the worker must end.
    [[nodiscard]] std::optional<Run> next() {
        std::unique_lock lock(mutex_);
        // With another case at hand its beginning goes out in one piece with the last answer.
        if (questions_.empty()) flush();
        changed_.wait(lock, [this] { return ending_ != Ending::none || !questions_.empty(); });
        if (ending_ != Ending::none) return std::nullopt;
        Run run = std::move(questions_.front());
        questions_.pop_front();
        return run;
    }
    void begin(const campaign::Attempt& attempt, bool resumed) {
        const std::lock_guard lock(mutex_);
        progress_ = std::numeric_limits<double>::quiet_NaN();
        running_ = attempt;
        write(Begun{attempt, resumed});
        flush();
    }
    /// Stores the progress of the running case, for the heartbeats.
    void advanced(double progress) {
        progress_ = progress;
        ++looks_;
    }
    [[nodiscard]] Ending ending() const { return ending_; }
    /// Sends the answer of the running case.
    void answer(Done done) {
        const std::lock_guard lock(mutex_);
        const std::size_t before = outgoing_.size();
        write(done);
        if (const std::size_t length = outgoing_.size() - before; length > longest_line) {
            outgoing_.resize(before);
            done.result.outcome = campaign::Outcome::rejected;
            done.result.observations = {};
            done.result.message = fmt::format("what it measured takes {} MB, more than the {} MB of a message",
                                              length >> 20U, longest_line >> 20U);
            write(done);
        }
        running_.reset();
    }
    void give_back() {
        const std::lock_guard lock(mutex_);
        write(GiveBack{*running_, reason_});
        running_.reset();
    }
    /// Gives back all cases because a file could not be written, and ends the process.
    [[noreturn]] void break_off(std::string reason) {
        mutex_.lock();
        reason_ = std::move(reason);
        if (running_) write(GiveBack{*running_, reason_, true});
        running_.reset();
        leave();
    }
    /// Gives back the cases that were never begun, and ends the process.
    [[noreturn]] void close() {
        mutex_.lock();
        leave();
    }

private:
    // ---- reading

    void read() {
        LineBuffer lines(longest_line);
        std::array<char, 65536> piece{};
        while (true) {
            const auto length = ::read(STDIN_FILENO, piece.data(), piece.size());
            if (length < 0 && errno == EINTR) continue;
            if (length <= 0) std::_Exit(main_program_is_gone);  // an answer is of no use
            const bool fits =
                lines.feed({piece.data(), static_cast<std::size_t>(length)}, [this](std::string_view line) {
                    take(line);
                    return true;
                });
            if (!fits) refuse(lines.begun(), "a line without an end");
        }
    }
    void take(std::string_view line) {
        silence_ = 0;
        try {
            ToWorker message = decode_to_worker(line);
            if (std::holds_alternative<Stop>(message)) return end(Ending::asked, "given back before it was finished");
            if (const auto* threads = std::get_if<Threads>(&message))
                return allow_threads(static_cast<int>(threads->count));
            auto* run = std::get_if<Run>(&message);
            if (run == nullptr) return;
            const std::lock_guard lock(mutex_);
            questions_.push_back(std::move(*run));
            changed_.notify_all();
        } catch (const std::invalid_argument& error) {
            refuse(line, error.what());
        }
    }

    // ---- signals and time

    void tick() {
        if (++silence_ > limits_.lease_seconds)
            end(Ending::silence, "its worker got no message from the main program for too long");
        const std::lock_guard lock(mutex_);
        if (ending_ != Ending::none && ++ending_for_ > limits_.give_back_seconds) leave();
        if (!running_ || !makes_headway()) return;
        write(Alive{*running_, progress_});
        flush();
    }
    void end(Ending why, std::string reason) {
        const std::lock_guard lock(mutex_);
        // Asked twice: at once. A host passes on a signal that all of its processes may have got: that is one request.
        if (ending_ == Ending::signal && why == Ending::signal && ending_for_ > 1) leave();
        if (ending_ == Ending::none || (ending_ == Ending::asked && why == Ending::signal)) {
            ending_ = why;
            reason_ = std::move(reason);
        }
        changed_.notify_all();
    }
    // With mutex_ held. Whatever is under way in the computing thread is not waited for: after this no line can follow.
    [[noreturn]] void leave() {
        if (running_) write(GiveBack{*running_, reason_ + ", and it could not be saved in time"});
        for (const auto& run : questions_) write(GiveBack{{run.question.id, run.attempt}, reason_});
        flush();
        std::_Exit(ending_ == Ending::silence ? main_program_is_gone : 0);
    }
    // A thread that has neither reported nor used its processor since the last heartbeat is blocked, for example by a
    // dead file server.
    [[nodiscard]] bool makes_headway() {
        timespec computed{};
        ::clock_gettime(computing_, &computed);
        const unsigned looks = looks_;
        const bool moved = looks != looks_seen_ || computed.tv_sec != computed_seen_.tv_sec ||
                           computed.tv_nsec != computed_seen_.tv_nsec;
        looks_seen_ = looks;
        computed_seen_ = computed;
        return moved;
    }

    // ---- writing

    void write(const ToBoss& message) {
        outgoing_ += encode(message);
        outgoing_ += '\n';
    }
    void flush() {
        if (!files::write_all(STDOUT_FILENO, outgoing_)) std::_Exit(main_program_is_gone);
        outgoing_.clear();
    }

    Limits limits_;
    clockid_t computing_{};  ///< processor time of the thread that computes
    std::mutex mutex_;       ///< guards all members below except the atomics
    std::condition_variable changed_;
    std::deque<Run> questions_;
    std::optional<campaign::Attempt> running_;
    std::string outgoing_;
    std::string reason_;  ///< of the ending
    std::atomic<Ending> ending_ = Ending::none;
    std::atomic<double> progress_;
    std::atomic<unsigned> looks_ = 0;  ///< calls of advanced()
    std::atomic<int> silence_ = 0;     ///< seconds since the main program wrote
    unsigned looks_seen_ = 0;          // of the thread that ticks
    timespec computed_seen_{};
    int ending_for_ = 0;  // seconds
};

// ---- answers ---------------------------------------------------------------------------------------------------

/// Interface by which a worker gets the answer of a case, from a simulation of the solver or from a program. Only the
/// worker distinguishes the two.
class Answerer {
public:
    Answerer() = default;
    Answerer(const Answerer&) = delete;
    Answerer& operator=(const Answerer&) = delete;
    virtual ~Answerer() = default;

    /// Looks for the checkpoint of an earlier attempt. Returns whether the case continues from it.
    [[nodiscard]] virtual bool prepare(const Run& run) = 0;
    /// Returns the answer of the case prepared last; empty if the case was interrupted because the worker must end.
    /// Throws SystemError for an error that every other case would meet, too.
    [[nodiscard]] virtual std::optional<campaign::CaseResult> answer(const Run& run) = 0;
    /// Returns whether a checkpoint of the case is stored, which is useless once the case is answered.
    [[nodiscard]] virtual bool left_checkpoint() const = 0;
};

constexpr std::string_view checkpoint_of_case = "checkpoint\ncase=";  // begins the key of every checkpoint

/// What a saved state belongs to besides its question: the machine code that made it and goes on from it. A version or
/// a commit does not say that much: sources may have changes of their own, or be built by another compiler.
std::string binding(const campaign::Computer& program) {
    return fmt::format("version={} ({})\nbuild={}\nlibc={}\npath={}\n", program.version, program.commit, program.build,
                       ::gnu_get_libc_version(), instruction_path());
}

/// Shared starting states, separate for each build and instruction path, because these round differently and a stored
/// state must have the same bits as a computed one.
class OwnArtefacts final : public Artefacts {
public:
    OwnArtefacts(files::ArtefactFolder* folder, const campaign::Computer& program)
        : folder_(folder), suffix_("\n" + binding(program)) {}
    [[nodiscard]] std::optional<Bytes> get(std::string_view key) override {
        return folder_ != nullptr ? folder_->get(std::string(key) + suffix_) : std::nullopt;
    }
    void put(std::string_view key, std::span<const std::byte> contents) override {
        if (folder_ != nullptr) folder_->put(std::string(key) + suffix_, contents);
    }

private:
    files::ArtefactFolder* folder_;
    std::string suffix_;
};

/// Saves and finds the state of an unfinished case. The name of the file contains the case and the build, not the
/// attempt: all attempts have the same bits, so each may continue any other.
class Checkpoints {
public:
    Checkpoints(files::ArtefactFolder* folder, const campaign::CaseId& id, const campaign::Computer& program)
        : folder_(folder), key_(checkpoint_key(id, program)) {}

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
    files::ArtefactFolder* folder_;
    std::string key_;
    bool exists_ = false;
};

/// Watch between the slices of a running case: reports progress, saves checkpoints, and interrupts the case when the
/// worker must end.
class CaseWatch {
public:
    CaseWatch(const WorkerOptions& options, MainConnection& desk, Checkpoints& checkpoints)
        : options_(options), desk_(desk), checkpoints_(checkpoints) {}

    bool operator()(const Scene& scene) {
        desk_.advanced(scene.progress());
        const auto now = Clock::now();
        if (seconds(now - saved_) > options_.checkpoint_seconds) {
            checkpoints_.save(scene);
            saved_ = Clock::now();
        }
        const auto ending = desk_.ending();
        if (ending == Ending::none) return true;
        if (!ending_seen_) ending_seen_ = now;
        if (ending == Ending::asked && seconds(now - *ending_seen_) < options_.finish_seconds) return true;
        checkpoints_.save(scene);
        return false;
    }

private:
    static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

    const WorkerOptions& options_;
    MainConnection& desk_;
    Checkpoints& checkpoints_;
    Clock::time_point saved_ = Clock::now();
    std::optional<Clock::time_point> ending_seen_;
};

/// Cases of the solver's scenes.
class Simulations final : public Answerer {
public:
    Simulations(const WorkerOptions& options, MainConnection& desk) : options_(options), desk_(desk) {
        if (options.artefacts.empty()) return;
        folder_.emplace(options.artefacts, [this](const std::string& sentence) {
            std::fprintf(stderr, "grainsweep: %s\n", sentence.c_str());
            damage_ += (damage_.empty() ? "" : "; ") + sentence;
        });
    }
    bool prepare(const Run& run) override {
        damage_.clear();
        if (folder_) enter_staged(run.question, *folder_);
        checkpoints_.emplace(folder_ ? &*folder_ : nullptr, run.question.id, options_.computer);
        // Looking for a checkpoint costs a failed open; only a case tried before can have one.
        resume_ = run.attempt > 1 ? checkpoints_->load() : std::nullopt;
        return resume_.has_value();
    }
    std::optional<campaign::CaseResult> answer(const Run& run) override {
        OwnArtefacts artefacts(folder_ ? &*folder_ : nullptr, options_.computer);
        CaseWatch watch(options_, desk_, *checkpoints_);
        auto result = compute(run.question, run.attempt, artefacts, resume_, std::ref(watch));
        // Of an answer that is no other for it; the reasons of other outcomes are compared between runs.
        if (result && result->outcome == campaign::Outcome::completed && !damage_.empty())
            result->message += (result->message.empty() ? "" : "; ") + damage_;
        return result;
    }
    bool left_checkpoint() const override { return checkpoints_->exists(); }

private:
    const WorkerOptions& options_;
    MainConnection& desk_;
    std::optional<files::ArtefactFolder> folder_;
    std::string damage_;  ///< met while computing the present case
    std::optional<Checkpoints> checkpoints_;
    std::optional<Bytes> resume_;
};

/// Cases of programs, found by the names of their scenes.
class Programs final : public Answerer {
public:
    Programs(const WorkerOptions& options, MainConnection& desk, ProgramGuard& guard)
        : options_(options), desk_(desk), guard_(guard) {}
    bool prepare(const Run&) override { return false; }
    std::optional<campaign::CaseResult> answer(const Run& run) override {
        auto& program = programs_[run.question.scene];
        if (!program)
            program = std::make_unique<ProgramAnswerer>(staged_program(run.question.scene, options_.cases),
                                                        ProgramOptions{options_.cases, options_.limit_seconds}, guard_);
        ending_seen_.reset();
        return program->answer(run.question, run.attempt, [this] { return goes_on(); });
    }
    bool left_checkpoint() const override { return false; }

private:
    bool goes_on() {
        desk_.advanced(std::numeric_limits<double>::quiet_NaN());
        const auto ending = desk_.ending();
        if (ending == Ending::none) return true;
        const auto now = Clock::now();
        if (!ending_seen_) ending_seen_ = now;
        return ending == Ending::asked &&
               std::chrono::duration<double>(now - *ending_seen_).count() < options_.finish_seconds;
    }

    const WorkerOptions& options_;
    MainConnection& desk_;
    ProgramGuard& guard_;
    std::map<std::string, std::unique_ptr<ProgramAnswerer>> programs_;
    std::optional<Clock::time_point> ending_seen_;
};

void answer(const Run& run, Answerer& answerer, MainConnection& desk) {
    desk.begin({run.question.id, run.attempt}, answerer.prepare(run));
    std::optional<campaign::CaseResult> result;
    try {
        result = answerer.answer(run);
    } catch (const SystemError& broken) {  // not the case's fault, and the next would meet it, too
        desk.break_off(
            fmt::format("what its cases need cannot be read or written: {}; mend that, free some space for "
                        "one, and run again to resume",
                        broken.what()));
    }
    if (result)
        desk.answer(Done{std::move(*result), answerer.left_checkpoint()});
    else
        desk.give_back();
}

/// Returns the version, commit and instruction path of a checkpoint's key, in words.
std::string origin_of(std::string_view key) {
    const auto line = [&](std::string_view name) {
        const auto at = key.find(fmt::format("\n{}=", name));
        if (at == std::string_view::npos) return std::string_view("?");
        const auto rest = key.substr(at + name.size() + 2);
        return rest.substr(0, rest.find('\n'));
    };
    return fmt::format("version {}, build {}, {}", line("version"), line("build").substr(0, 12), line("path"));
}

}  // namespace

std::string checkpoint_key(const campaign::CaseId& id, const campaign::Computer& program) {
    return fmt::format("{}{}\n{}", checkpoint_of_case, id, binding(program));
}

std::optional<campaign::CaseId> checkpointed_case(std::string_view key) {
    if (!key.starts_with(checkpoint_of_case)) return std::nullopt;
    key.remove_prefix(checkpoint_of_case.size());
    return campaign::CaseId(key.substr(0, key.find('\n')));
}

std::map<campaign::CaseId, std::string> checkpoints_of_others(const files::ArtefactFolder& folder,
                                                              const campaign::Computer& program, bool any_path) {
    const auto build = fmt::format("\nbuild={}\n", program.build);
    std::map<campaign::CaseId, std::string> others;
    std::set<campaign::CaseId> own;
    folder.visit([&](std::string_view key) {
        const auto id = checkpointed_case(key);
        if (!id) return;
        const bool fits = any_path ? key.find(build) != std::string_view::npos : key == checkpoint_key(*id, program);
        if (fits)
            own.insert(*id);
        else
            others[*id] = fmt::format(
                "from the beginning: the checkpoint is of another program ({}), and only the build and instruction "
                "path that saved it can continue it",
                origin_of(key));
    });
    std::erase_if(others, [&](const auto& one) { return own.contains(one.first); });
    return others;
}

bool shoot_checkpoint(const campaign::Case& question, const std::filesystem::path& artefacts,
                      const campaign::Computer& program, const Camera& camera) {
    files::ArtefactFolder folder(artefacts);
    const auto saved = folder.get(checkpoint_key(question.id, program));
    if (!saved) return false;
    OwnArtefacts shared(&folder, program);
    (void)compute(
        question, 1, shared, saved, [](const Scene&) { return false; }, camera);
    return true;
}

int work(const WorkerOptions& options) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a local main program; a remote one is noticed by end of file and lease
    std::optional<ProgramGuard> guard;   // forks: before there are threads
    if (!options.cases.empty()) guard.emplace();

    // Outlives main: its threads are never joined.
    static MainConnection* desk = new MainConnection({options.lease_seconds, options.give_back_seconds});
    std::unique_ptr<Answerer> answerer;
    if (guard)
        answerer = std::make_unique<Programs>(options, *desk, *guard);
    else
        answerer = std::make_unique<Simulations>(options, *desk);
    desk->open(options.computer);
    while (const auto run = desk->next()) answer(*run, *answerer, *desk);
    answerer.reset();  // a program that stays alive is asked to end
    desk->close();
}

}  // namespace grainsweep::workers
