// Surroundings of a program: its command, environment and files for a case. Also how workers find the program itself.
#include "sweep/campaign/output_pattern.hpp"
#include "sweep/campaign/placeholders.hpp"
#include "sweep/files/system_error.hpp"
#include "sweep/files/whole_file.hpp"
#include "sweep/workers/program_answerer.hpp"
#include "sweep/workers/program_process.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace grainsweep::workers {
namespace {

namespace fs = std::filesystem;
using campaign::Program;

constexpr std::size_t largest_in_memory = 1U << 20U;
constexpr double version_seconds = 20;
constexpr std::size_t longest_version = 200, longest_answer = 1U << 20U;

std::string formatted(std::uint64_t number, std::string_view format) {
    const auto form = campaign::NumberFormat::parse(format);
    return form ? (*form)(number) : std::to_string(number);
}

/// Value of a placeholder; nothing for braces of the command's own, which have no name of the case.
std::optional<std::string> value_named(std::string_view name, std::string_view format, const Program& program,
                                       const campaign::Case* question) {
    constexpr std::uint64_t most_of_31_bits = 0x7FFFFFFE;
    if (name == "threads") return formatted(static_cast<std::uint64_t>(program.cores), format);
    const bool own = !format.empty() && !campaign::NumberFormat::parse(format);
    const bool varied = question != nullptr && question->inputs.contains(name);  // a parameter that is older than this
    if (name == "processes" && !varied) return formatted(static_cast<std::uint64_t>(program.processes), format);
    if (question == nullptr && own) return std::nullopt;
    if (question == nullptr) throw std::logic_error("a program that stays alive has no case");
    if (const auto input = question->inputs.find(name); input != question->inputs.end())
        return campaign::program_value(input->second, format);
    if (name == "seed") return formatted(question->seed, format);
    if (name == "seed31") return formatted(1 + question->seed % most_of_31_bits, format);
    if (name == "seed_prime") return formatted(campaign::prime_of(question->seed), format);
    if (name == "case") return question->id;
    if (own) return std::nullopt;
    throw SystemError(fmt::format("the case has no '{}'", name));
}

/// Adds variables by which the ranks of a case run on the node of its worker, on any of its cores. What the user sets
/// has priority.
void add_mpi_variables(std::vector<std::string>& environment, const Program& program) {
    if (program.processes < 2) return;
    const auto set = [&](const char* name, const char* value) {
        if (std::getenv(name) == nullptr && !program.environment.contains(name))
            environment.push_back(fmt::format("{}={}", name, value));
    };
    // Open MPI would bind the ranks of all cases of a node to its first cores.
    set("OMPI_MCA_hwloc_base_binding_policy", "none");
    set("PRTE_MCA_hwloc_default_binding_policy", "none");
    if (std::getenv("SLURM_STEP_ID") == nullptr) return;
    // Within a step of srun, mpirun would wait for a step of its own, and the step of this worker has its cores.
    for (const char* name : {"OMPI_MCA_plm", "OMPI_MCA_ras", "PRTE_MCA_plm", "PRTE_MCA_ras"}) set(name, "^slurm");
    for (const char* name : {"HYDRA_BOOTSTRAP", "I_MPI_HYDRA_BOOTSTRAP"}) set(name, "fork");  // MPICH, Intel
}

fs::path place_of(std::string_view scene, const fs::path& cases) {
    return cases / fmt::format("program-{}", scene.substr(campaign::program_prefix.size()));
}

std::string text_of(const fs::path& file) {
    std::error_code error;
    std::string text = files::whole_file(file, error);
    if (error) throw SystemError(fmt::format("'{}': cannot be read: {}", file.string(), error.message()));
    return text;
}

void put(const fs::path& file, std::string_view text) {
    const auto aside = fs::path(file) += fmt::format(".{}", ::getpid());
    std::ofstream stream(aside, std::ios::binary);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    std::error_code error;
    if (stream) fs::rename(aside, file, error);
    if (!stream || error) throw SystemError(fmt::format("'{}': cannot be written", file.string()));
}

}  // namespace

std::vector<std::string> program_argv(const Program& program, const campaign::Case* question) {
    const auto value = [&](auto name, auto format) { return value_named(name, format, program, question); };
    std::vector<std::string> argv;
    for (const auto& word : program.command) argv.push_back(campaign::filled_command(word, value));
    if (argv.front().find('/') != std::string::npos) return argv;  // its own file, or where the user says
    auto path = find_program(argv.front());
    if (path.empty()) throw SystemError(fmt::format("there is no program '{}' on the search path", argv.front()));
    argv.front() = std::move(path);
    return argv;
}

std::vector<std::string> program_environment(const Program& program, const campaign::Case* question) {
    const auto value = [&](auto name, auto format) { return value_named(name, format, program, question); };
    std::vector<std::string> environment;
    for (const auto& [name, text] : program.environment)
        environment.push_back(fmt::format("{}={}", name, campaign::filled_command(text, value)));
    add_mpi_variables(environment, program);
    return environment;
}

void fill_folder(const ProgramFolder& folder, const Program& program, const campaign::Case* question) {
    for (const auto& file : program.files) {
        if (file.is_template) {
            const auto value = [&](auto name, auto format) { return value_named(name, format, program, question); };
            const auto text = file.path.empty() ? file.contents : text_of(file.path);
            folder.write(file.name, campaign::filled_template(text, value), file.executable);
        } else if (file.path.empty()) {
            folder.write(file.name, file.contents, file.executable);
        } else {
            folder.copy(file.name, file.path, file.executable);
        }
    }
    if (question != nullptr)
        folder.write("inputs.json",
                     campaign::program_question(question->id, question->seed, program.cores, question->inputs) + "\n",
                     false);
}

// ---- version ---------------------------------------------------------------------------------------------------

std::string why_not_here(const Program& program) {
    const auto& word = program.command.front();
    if (word.find('{') != std::string::npos) return {};                            // each case's own
    if (word.find('/') != std::string::npos && !word.starts_with('/')) return {};  // among its files
    return find_program(word).empty() ? fmt::format("there is no program '{}' that may be executed", word) : "";
}

std::string ask_version(const Program& program, ProgramGuard& guard) {
    ProgramFolder folder(fs::temp_directory_path() /
                         fmt::format("grainsweep-version-{}{}", ::getpid(), running_suffix));
    fill_folder(
        folder,
        [&] {
            Program files = program;
            std::erase_if(files.files, [](const auto& file) { return file.is_template; });
            return files;
        }(),
        nullptr);
    ProcessStart start{program.version_command};
    if (start.argv.front().find('/') == std::string::npos) start.argv.front() = find_program(start.argv.front());
    if (start.argv.front().empty())
        throw std::runtime_error(fmt::format("there is no program '{}'", program.version_command.front()));
    start.folder = folder.descriptor();
    const auto answer = folder.create("stdout.txt");
    start.streams = {-1, answer.number(), answer.number()};
    start.file = program.disk;  // some libraries make files of their own elsewhere
    std::string text, why;
    {
        ProgramProcess process(start, guard);
        if (!process.wait(version_seconds)) throw std::runtime_error("it did not say its version within 20 s");
        text = folder.read("stdout.txt", longest_answer + 1, why).value_or("");
    }
    std::smatch parts;
    const auto pattern = campaign::output_pattern(program.version_match);
    for (std::string_view rest = text; !rest.empty();) {
        const auto end = std::min(rest.find('\n'), rest.size());
        const std::string line(rest.substr(0, std::min<std::size_t>(end, 4096)));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (!std::regex_search(line, parts, pattern)) continue;
        auto version = parts[1].str();
        const bool plain = std::ranges::all_of(version, [](char c) { return c >= 0x20 && c < 0x7F; });
        if (version.empty() || version.size() > longest_version || !plain)
            throw std::runtime_error("what it says of its version is no short text in ASCII");
        return version;
    }
    throw std::runtime_error(fmt::format("what it wrote has no version: {}", shortened(text, 200)));
}

// ---- where workers find it -------------------------------------------------------------------------------------

void stage_program(const Program& program, const fs::path& cases) {
    const auto folder = place_of(campaign::program_scene_name(program), cases);
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw SystemError(fmt::format("'{}': cannot be made: {}", folder.string(), error.message()));
    for (const auto& file : program.files) {
        if (!file.path.empty() && fs::equivalent(file.path, folder / file.hash, error)) continue;
        put(folder / file.hash, file.path.empty() ? file.contents : text_of(file.path));
    }
    put(folder / "definition.json", campaign::program_text(program));
}

std::shared_ptr<const Program> staged_program(std::string_view scene, const fs::path& cases) {
    const auto folder = place_of(scene, cases);
    auto program = std::make_shared<Program>();
    try {
        *program = campaign::program_in(text_of(folder / "definition.json"));
    } catch (const std::invalid_argument& why) {
        throw SystemError(fmt::format("'{}': {}", (folder / "definition.json").string(), why.what()));
    }
    if (campaign::program_scene_name(*program) != scene)
        throw SystemError(fmt::format("'{}': is not as it was written", (folder / "definition.json").string()));
    for (auto& file : program->files) {
        auto contents = text_of(folder / file.hash);
        if (campaign::content_hash(contents) != file.hash)
            throw SystemError(fmt::format("'{}': is not as it was written", (folder / file.hash).string()));
        if (contents.size() > largest_in_memory)
            file.path = folder / file.hash;
        else
            file.contents = std::move(contents);
    }
    return program;
}

void unstage_program(std::string_view scene, const fs::path& cases) {
    std::error_code ignored;
    fs::remove_all(place_of(scene, cases), ignored);
    fs::remove(cases, ignored);  // where it is empty
}

}  // namespace grainsweep::workers
