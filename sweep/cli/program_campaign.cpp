#include "sweep/cli/program_campaign.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/store/when_clauses.hpp"
#include "sweep/workers/program_answerer.hpp"
#include "sweep/workers/program_guard.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace grainsweep::cli {

namespace fs = std::filesystem;

campaign::Campaign with_program(campaign::Campaign campaign, const fs::path& config) {
    campaign.space.when = campaign::asked_in(config, [&] { return store::when_clauses(campaign.space); });
    const auto program = campaign::known_program(campaign.scene().name);
    if (program == nullptr) return campaign;
    const std::string place = config.string() + ": $.program.";
    if (campaign.execution.launcher.empty())
        if (const auto why = workers::why_not_here(*program); !why.empty())
            throw campaign::input_error(place + "command[0]", program->command.front(), why);
    if (program->version_command.empty()) return campaign;
    auto versioned = std::make_shared<campaign::Program>(*program);
    try {
        workers::ProgramGuard guard;
        versioned->version = workers::ask_version(*program, guard);
    } catch (const std::runtime_error& why) {
        throw campaign::input_error(place + "version", "", why.what());
    }
    campaign.space.scene = campaign::enter_program(std::move(versioned));
    return campaign;
}

campaign::Campaign read_with_program(const fs::path& config, std::string_view experiment) {
    return with_program(campaign::read_campaign(config, experiment), config);
}

campaign::Campaign parse_with_program(std::string_view text, const fs::path& config) {
    auto campaign = campaign::asked_in(config, [&] { return campaign::parse_campaign(text, config.parent_path()); });
    return with_program(std::move(campaign), config);
}

StagedProgram::StagedProgram(std::shared_ptr<const campaign::Program> program, fs::path cases)
    : program_(std::move(program)), cases_(std::move(cases)) {
    if (program_ == nullptr) return;
    workers::sweep_program_folders(cases_);
    workers::stage_program(*program_, cases_);
}

StagedProgram::~StagedProgram() {
    if (program_ == nullptr) return;
    workers::sweep_program_folders(cases_);
    workers::unstage_program(campaign::program_scene_name(*program_), cases_);
}

campaign::CaseResult answer_by_program(std::shared_ptr<const campaign::Program> program, const campaign::Case& question,
                                       std::int64_t attempt, std::optional<double> limit_seconds, const fs::path& keep,
                                       const PictureRequest& pictures) {
    if (pictures.any())
        throw campaign::input_error(!pictures.folder.empty() ? "--vtk"
                                    : !pictures.page.empty() ? "--watch"
                                                             : "--contacts",
                                    "", "a program has no pictures of its case; --keep DIR keeps its files");
    fs::path wanted = keep.empty() ? keep : fs::absolute(keep);
    if (!wanted.empty() && !wanted.has_filename()) wanted = wanted.parent_path();
    if (std::error_code none; !wanted.empty() && fs::exists(fs::symlink_status(wanted, none)))
        throw campaign::input_error("--keep", keep.string(), "exists already; name a new folder");
    if (!wanted.empty() && program->protocol == campaign::Program::Protocol::lines)
        throw campaign::input_error("--keep", keep.string(),
                                    "a program of the protocol \"lines\" has no folder of its case");
    workers::ProgramGuard guard;
    const fs::path cases = fs::temp_directory_path() / fmt::format("grainsweep-{}", ::getpid());
    struct Removed {  // in the end
        const fs::path& folder;
        ~Removed() {
            std::error_code ignored;
            fs::remove_all(folder, ignored);
        }
    } const removed{cases};
    fs::create_directories(cases);
    workers::ProgramAnswerer answerer(std::move(program), {cases, limit_seconds, wanted}, guard);
    return answerer.answer(question, attempt, [] { return true; }).value();  // nothing gives it up
}

}  // namespace grainsweep::cli
