#include "sweep/workers/worker.hpp"

#include "sweep/campaign/machine.hpp"
#include "sweep/workers/staged_campaign.hpp"

#include "sweep/files/artefacts.hpp"
#include "sweep/files/broken_world.hpp"
#include "sweep/workers/answerer.hpp"
#include "sweep/workers/compute.hpp"
#include "sweep/workers/desk.hpp"
#include "sweep/workers/message.hpp"
#include "sweep/workers/program_answerer.hpp"

#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <sys/prctl.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace grainsweep::workers {
namespace {

using Clock = std::chrono::steady_clock;

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
    CaseWatch(const WorkerOptions& options, Desk& desk, Checkpoints& checkpoints)
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
    Desk& desk_;
    Checkpoints& checkpoints_;
    Clock::time_point saved_ = Clock::now();
    std::optional<Clock::time_point> ending_seen_;
};

/// Cases of the solver's scenes.
class Simulations final : public Answerer {
public:
    Simulations(const WorkerOptions& options, Desk& desk) : options_(options), desk_(desk) {
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
    Desk& desk_;
    std::optional<files::ArtefactFolder> folder_;
    std::string damage_;  ///< met while computing the present case
    std::optional<Checkpoints> checkpoints_;
    std::optional<Bytes> resume_;
};

/// Cases of programs, found by the names of their scenes.
class Programs final : public Answerer {
public:
    Programs(const WorkerOptions& options, Desk& desk, ProgramGuard& guard)
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
    Desk& desk_;
    ProgramGuard& guard_;
    std::map<std::string, std::unique_ptr<ProgramAnswerer>> programs_;
    std::optional<Clock::time_point> ending_seen_;
};

void answer(const Run& run, Answerer& answerer, Desk& desk) {
    desk.begin({run.question.id, run.attempt}, answerer.prepare(run));
    std::optional<campaign::CaseResult> result;
    try {
        result = answerer.answer(run);
    } catch (const BrokenWorld& broken) {  // not the case's fault, and the next would meet it, too
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
    static Desk* desk = new Desk({options.lease_seconds, options.give_back_seconds});
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
