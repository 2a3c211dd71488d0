// Main function, and the only place that catches all exceptions.
#include "solver/scenes/scene.hpp"
#include "stats/several_responses.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/json_writer.hpp"
#include "sweep/campaign/visible_stream.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/store/store.hpp"
#include "sweep/workers/end_requests.hpp"
#include "sweep/workers/job_cores.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <string_view>

namespace {

using namespace grainsweep;

constexpr int input_error = 2;
constexpr int system_error = 3;

/// Writes the reason why a command ended; with `json` also as an object on standard output, for programs.
int complain(int code, const std::string& sentence, bool json) {
    std::cerr << "grainsweep: " << sentence << '\n';
    if (json) {
        const campaign::JsonText error = {{"error", {{"code", code}, {"message", sentence}}}};
        std::cout << error.text() << std::endl;
    }
    return code;
}

/// Whether the arguments request JSON, even if they are wrong otherwise.
bool request_json(int argc, const char* const* argv) {
    for (int k = 1; k < argc; ++k) {
        const std::string_view argument = argv[k];
        if (argument == "--format=json") return true;
        if (argument == "--format" && k + 1 < argc && std::string_view(argv[k + 1]) == "json") return true;
    }
    return false;
}

/// Returns the exit code after flushing standard output; an error if the output could not be written, as on a full
/// disk.
int flushed(int code) {
    errno = 0;
    std::cout.flush();
    if (!std::cout || std::fflush(stdout) != 0) {
        const std::string why = errno == 0 ? "" : std::string(": ") + std::strerror(errno);  // lost in an earlier write
        throw SystemError("standard output cannot be written" + why + ".");
    }
    return code;
}

/// The next opened file, perhaps the database, would get a closed descriptor from 0 to 2, and every message would be
/// written into this file. Opened the wrong way round, so that using it is still an error.
void occupy_standard_descriptors() {
    for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
        if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
        if (::open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY) != descriptor)
            std::_Exit(system_error);
    }
}

/// Whether a command answers requests to end with its own exit codes, from its first moment.
bool runs_cases(std::string_view command) {
    constexpr std::array<std::string_view, 5> commands = {"run", "calibrate", "accuracy", "work", "collect"};
    return std::ranges::count(commands, command) > 0;
}

}  // namespace

int main(int argc, char** argv) {
    occupy_standard_descriptors();
    if (argc > 1 && runs_cases(argv[1])) workers::answer_end_requests();
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is a full disk: said, not died of
    stats::allow_fits_at_once(workers::job_cores());
    if (const auto why = unsupported_processor(); !why.empty())
        return complain(system_error, why, request_json(argc, argv));
    const campaign::VisibleStream output(std::cout), errors(std::cerr);
    try {
        return flushed(cli::parse_command_line(cli::all_commands(), argc, argv)());
    } catch (const campaign::InputError& error) {
        return complain(input_error, error.what(), request_json(argc, argv));
    } catch (const std::exception& error) {  // SystemError and everything unforeseen
        return complain(system_error, error.what(), request_json(argc, argv));
    }
}
