#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "files.hpp"

extern "C" {
#include "realtime/machine.h"
}

namespace
{

namespace fs = std::filesystem;

class Machine : public testing::Test
{
  protected:
    void write(const std::string &path, const std::string &text) const
    {
        fs::create_directories((root / path).parent_path());
        std::ofstream(root / path) << text;
    }
    void govern(int cpu, const std::string &governor) const
    {
        write("sys/devices/system/cpu/cpu" + std::to_string(cpu) + "/cpufreq/scaling_governor",
              governor + "\n");
    }
    ale_rt_report_t governor(int cpu) const
    {
        ale_rt_findings_t findings{};
        ale_rt_check_governor(&findings, cpu, root.c_str());
        ale_rt_report_t report;
        ale_rt_findings_report(&findings, &report);
        return report;
    }
    ale_rt_report_t kernel() const
    {
        ale_rt_findings_t findings{};
        ale_rt_check_kernel(&findings, root.c_str());
        ale_rt_report_t report;
        ale_rt_findings_report(&findings, &report);
        return report;
    }

    const files::TemporaryFolder folder;
    const fs::path root = folder.path();
};

TEST_F(Machine, OnlyAKernelThatSaysSoIsPreemptRt)
{
    EXPECT_FALSE(kernel().realtime);
    EXPECT_NE(std::string(kernel().text).find("missing: PREEMPT_RT kernel (this is "), std::string::npos);
    write("sys/kernel/realtime", "0\n");
    EXPECT_FALSE(kernel().realtime);
    write("sys/kernel/realtime", "1\n");
    EXPECT_TRUE(kernel().realtime);
    EXPECT_EQ(std::string(kernel().text).rfind("PREEMPT_RT kernel ", 0), 0u);
}

TEST_F(Machine, AGovernorThatLowersTheFrequencyIsNamedWithItsProcessor)
{
    EXPECT_STREQ(governor(0).text, "constant frequency");
    govern(0, "performance");
    EXPECT_STREQ(governor(0).text, "governor performance");
    if (sysconf(_SC_NPROCESSORS_CONF) > 1) {
        govern(1, "powersave");
        EXPECT_TRUE(governor(0).realtime)
            << "another processor's does not matter when the task is bound to one";
        EXPECT_FALSE(governor(-1).realtime);
        EXPECT_NE(std::string(governor(1).text).find("(processor 1 has powersave)"), std::string::npos);
    }
}

TEST_F(Machine, FindingsAreListedInTheirOrderAndCutWhereTheyDoNotFit)
{
    ale_rt_findings_t findings{};
    ale_rt_report_t report;
    ale_rt_found(&findings, true, "one %d", 1);
    ale_rt_found(&findings, false, "two");
    ale_rt_found(&findings, true, "%s", "three");
    ale_rt_findings_report(&findings, &report);
    EXPECT_STREQ(report.text, "one 1, three; missing: two");
    for (int k = 0; k < 50; k++) {
        ale_rt_found(&findings, k % 2 == 0, "a long finding %d", k);
    }
    ale_rt_findings_report(&findings, &report);
    EXPECT_LT(std::string(report.text).size(), sizeof report.text);
}

} // namespace
