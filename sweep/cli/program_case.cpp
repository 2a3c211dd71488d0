#include "sweep/cli/program_case.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/workers/program_answerer.hpp"
#include "sweep/workers/program_guard.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <utility>

namespace grainsweep::cli {

namespace fs = std::filesystem;

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
