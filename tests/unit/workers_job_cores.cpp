// Cores of the job: quotas of control groups under a made root, what Slurm says, affinity.
#include "sweep/workers/job_cores.hpp"

#include "solver/own_cores.hpp"
#include "tests/support/archive.hpp"

#include <gtest/gtest.h>
#include <sched.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>

namespace grainsweep::tests::workers_job_cores_test {

using namespace workers;

namespace fs = std::filesystem;

struct Root {
    tests::Folder folder;
    void write(const std::string& name, const std::string& text) const {
        const auto file = folder.path() / name;
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    [[nodiscard]] std::optional<std::size_t> cores() const { return quota_cores(folder.path()); }
};

TEST(JobCores, TheSmallestQuotaOfAllGroupsAboveCountsInVersion2) {
    const Root root;
    root.write("proc/self/cgroup", "0::/jobs/job_7/step 1\n");
    EXPECT_FALSE(root.cores()) << "no group is there";
    root.write("sys/fs/cgroup/jobs/job_7/step 1/cpu.max", "max 100000\n");
    EXPECT_FALSE(root.cores());
    root.write("sys/fs/cgroup/jobs/job_7/cpu.max", "800000 100000\n");
    EXPECT_EQ(root.cores(), 8U);
    root.write("sys/fs/cgroup/jobs/cpu.max", "350000 100000\n");
    EXPECT_EQ(root.cores(), 3U) << "three and a half";
    root.write("sys/fs/cgroup/jobs/job_7/step 1/cpu.max", "20000 100000\n");
    EXPECT_EQ(root.cores(), 1U) << "a fifth of a core is one worker";
}

TEST(JobCores, AContainerSeesItsOwnGroupAsTheUppermost) {
    const Root root;
    root.write("proc/self/cgroup", "0::/\n");
    root.write("sys/fs/cgroup/cpu.max", "200000 100000\n");
    EXPECT_EQ(root.cores(), 2U);
    root.write("proc/self/cgroup", "0::/docker/0123abc\n");
    EXPECT_EQ(root.cores(), 2U) << "its path is that of the host";
}

TEST(JobCores, Version1HasAControllerForProcessorTime) {
    const Root root;
    root.write("proc/self/cgroup", "12:memory:/job_7\n4:cpu,cpuacct:/job_7\n1:name=systemd:/user\n0::/user\n");
    root.write("sys/fs/cgroup/memory/job_7/cpu.cfs_quota_us", "100000\n");
    root.write("sys/fs/cgroup/memory/job_7/cpu.cfs_period_us", "100000\n");
    EXPECT_FALSE(root.cores()) << "of another controller";
    root.write("sys/fs/cgroup/cpu,cpuacct/job_7/cpu.cfs_quota_us", "-1\n");
    root.write("sys/fs/cgroup/cpu,cpuacct/job_7/cpu.cfs_period_us", "100000\n");
    EXPECT_FALSE(root.cores());
    root.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "600000\n");
    root.write("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(root.cores(), 6U);
    root.write("sys/fs/cgroup/cpu/job_7/cpu.cfs_quota_us", "100000\n");
    root.write("sys/fs/cgroup/cpu/job_7/cpu.cfs_period_us", "50000\n");
    EXPECT_EQ(root.cores(), 2U) << "mounted by another name";
}

TEST(JobCores, WhatIsNoGroupIsNoQuota) {
    const Root root;
    EXPECT_FALSE(root.cores());
    for (const char* text : {"", "\n", "nonsense", "0:", "0::", "::::", "4:cpu:"}) {
        root.write("proc/self/cgroup", text);
        EXPECT_FALSE(root.cores()) << text;
    }
    root.write("proc/self/cgroup", "0::/a\n");
    for (const char* text : {"", "max", "100000", "a b", "0 100000", "100000 0", "-5 100000", "1 2 3"}) {
        root.write("sys/fs/cgroup/a/cpu.max", text);
        EXPECT_FALSE(root.cores()) << text;
    }
}

std::optional<std::size_t> of_slurm(const std::map<std::string, std::string>& variables) {
    return slurm_cores([&](const char* name) -> std::optional<std::string> {
        const auto found = variables.find(name);
        return found == variables.end() ? std::nullopt : std::optional(found->second);
    });
}

TEST(JobCores, SlurmGivesThemToATask) {
    EXPECT_FALSE(of_slurm({}));
    EXPECT_EQ(of_slurm({{"SLURM_CPUS_PER_TASK", "8"}}), 8U);
    EXPECT_EQ(of_slurm({{"SLURM_CPUS_ON_NODE", "16"}}), 16U);
    // The script of a job with 16 tasks of 2 on each of its nodes, and a task that srun starts there.
    const std::map<std::string, std::string> job = {{"SLURM_CPUS_PER_TASK", "2"}, {"SLURM_TASKS_PER_NODE", "16(x4)"}};
    EXPECT_EQ(of_slurm(job), 32U);
    auto step = job;
    step["SLURM_STEP_ID"] = "0";
    EXPECT_EQ(of_slurm(step), 2U);
    auto smaller = job;
    smaller["SLURM_CPUS_ON_NODE"] = "24";
    EXPECT_EQ(of_slurm(smaller), 24U);
    for (const char* text : {"", "0", "-1", "many", "1e400", "nan"}) {
        EXPECT_FALSE(of_slurm({{"SLURM_CPUS_PER_TASK", text}})) << text;
        EXPECT_FALSE(of_slurm({{"SLURM_CPUS_ON_NODE", text}})) << text;
    }
}

TEST(JobCores, AProcessBoundToOneCoreHasOne) {
    EXPECT_GE(job_cores(), 1U);
    EXPECT_LE(job_cores(), static_cast<std::size_t>(own_cores()));
    int bound = 0;
    std::thread([&] {  // affinity is a thread's
        cpu_set_t all, one;
        ASSERT_EQ(::sched_getaffinity(0, sizeof all, &all), 0);
        int first = 0;
        while (!CPU_ISSET(first, &all)) ++first;
        CPU_ZERO(&one);
        CPU_SET(first, &one);
        ASSERT_EQ(::sched_setaffinity(0, sizeof one, &one), 0);
        bound = own_cores();
    })
        .join();
    EXPECT_EQ(bound, 1);
}

}  // namespace grainsweep::tests::workers_job_cores_test
