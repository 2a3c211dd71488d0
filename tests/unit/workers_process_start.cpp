// Processes as they are started: what they inherit, and what is left of one that cannot be executed.
#include "sweep/workers/process_start.hpp"

#include "sweep/files/descriptor.hpp"
#include "sweep/files/whole_file.hpp"
#include "tests/support/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace grainsweep::tests::workers_process_start_test {

using namespace workers;
using testing::HasSubstr;

struct Answer {
    int status = 0;
    std::string text;
};

/// Runs a command to its end.
Answer run(const std::vector<std::string>& command, bool stranger, std::vector<std::string> environment = {}) {
    const Folder folder(in_memory());
    const auto out = (folder.path() / "out").string();
    const files::Descriptor file(::open(out.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
    const files::Descriptor here(::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    ProcessStart start{command};
    start.argv.front() = find_program(command.front());
    start.environment = std::move(environment);
    start.streams = {-1, file.number(), file.number()};
    start.folder = here.number();
    start.stranger = stranger;
    std::error_code error;
    const pid_t id = start_process(start, error);
    EXPECT_GT(id, 0) << error.message();
    Answer answer;
    EXPECT_EQ(::waitpid(id, &answer.status, 0), id);
    answer.text = files::whole_file(out, error);
    return answer;
}

/// The signals of a mask, as the system shows it.
unsigned long mask(const Answer& answer, const std::string& name) {
    const auto at = answer.text.find(name + ":\t");
    return at == std::string::npos ? ~0UL : std::stoul(answer.text.substr(at + name.size() + 2), nullptr, 16);
}

bool has_children() {
    return ::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

#if !defined(__SANITIZE_THREAD__)  // which makes vfork a fork: its child cannot report why exec failed
TEST(ProcessStart, AProgramThatCannotBeExecutedLeavesNoProcess) {
    const Folder folder;
    folder.write("script", "#!/there/is/no/such/interpreter\n");
    const auto script = (folder.path() / "script").string();
    std::filesystem::permissions(script, std::filesystem::perms::owner_all);
    EXPECT_EQ(find_program(script), script);
    for (int k = 0; k < 50; ++k) {
        std::error_code error;
        ProcessStart start{{script}};
        start.stranger = true;
        EXPECT_EQ(start_process(start, error), -1);
        EXPECT_EQ(error, std::errc::no_such_file_or_directory);
        ASSERT_FALSE(has_children());
    }
    const auto log = (folder.path() / "log").string();
    const files::Descriptor file(::open(log.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
    ProcessStart start{{script}};
    start.streams[2] = file.number();
    std::error_code error;
    const pid_t id = start_process(start, error);
    ASSERT_GT(id, 0);
    int status = 0;
    EXPECT_EQ(::waitpid(id, &status, 0), id);
    EXPECT_THAT(describe_end("it", status), HasSubstr("ended with exit code"));
    EXPECT_EQ(files::whole_file(log, error), "it cannot be executed: No such file or directory");
}
#endif

TEST(ProcessStart, AStrangerGetsNoSignalsAndNoDescriptorsOfThisProcess) {
    const files::Descriptor open_for_all(::fcntl(STDERR_FILENO, F_DUPFD, 100));
    sigset_t blocked, before;
    ::sigemptyset(&blocked);
    ::sigaddset(&blocked, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &blocked, &before);
    const auto ignored = std::signal(SIGPIPE, SIG_IGN);
    const std::vector<std::string> masks = {"grep", "^Sig", "/proc/self/status"};
    const auto stranger = run(masks, true), own = run(masks, false);
    const std::vector<std::string> inherited = {"test", "-e", fmt::format("/proc/self/fd/{}", open_for_all.number())};
    EXPECT_EQ(run(inherited, false).status, 0);
    EXPECT_NE(run(inherited, true).status, 0);
    std::signal(SIGPIPE, ignored);
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    EXPECT_EQ(mask(stranger, "SigBlk"), 0U);
    EXPECT_EQ(mask(stranger, "SigIgn"), 0U);
    EXPECT_TRUE(mask(own, "SigBlk") >> (SIGTERM - 1U) & 1U);
    EXPECT_TRUE(mask(own, "SigIgn") >> (SIGPIPE - 1U) & 1U);
    sigset_t now;
    ::pthread_sigmask(SIG_SETMASK, nullptr, &now);
    EXPECT_EQ(::sigismember(&now, SIGTERM), ::sigismember(&before, SIGTERM)) << "the mask of this thread is as before";
}

TEST(ProcessStart, ALaterVariableReplacesAnEarlierOne) {
    for (const bool stranger : {false, true})
        EXPECT_EQ(run({"printenv", "HOME"}, stranger, {"HOME=of this process"}).text, "of this process\n");
}

TEST(ProcessStart, EachIsTheHeadOfAGroupOfItsOwn) {
    for (const bool stranger : {false, true}) {
        const auto answer = run({"cut", "-d ", "-f1,5", "/proc/self/stat"}, stranger);
        const auto blank = answer.text.find(' ');
        EXPECT_EQ(answer.text.substr(0, blank) + "\n", answer.text.substr(blank + 1));
    }
}

}  // namespace grainsweep::tests::workers_process_start_test
