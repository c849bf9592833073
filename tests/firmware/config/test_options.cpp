#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "files.hpp"

extern "C" {
#include "config/options.h"
#include "realtime/clock.h"
}

namespace
{

struct Answer {
    ale_options_result_t result;
    std::string out;
    std::string err;
    std::unique_ptr<ale_options_t> options;
};

Answer read(std::vector<std::string> words)
{
    words.insert(words.begin(), "ale-slamd");
    std::vector<char *> arguments;
    for (std::string &word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    char *text = nullptr;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    Answer answer{ALE_OPTIONS_RUN, "", "", std::make_unique<ale_options_t>()};
    testing::internal::CaptureStderr();
    answer.result =
        ale_options_read(static_cast<int>(words.size()), arguments.data(), answer.options.get(), out);
    answer.err = testing::internal::GetCapturedStderr();
    fclose(out);
    answer.out = std::string(text, size);
    free(text);
    return answer;
}

TEST(Options, NoneMeansTheDefaultsInRealTime)
{
    const Answer answer = read({});
    EXPECT_EQ(answer.result, ALE_OPTIONS_RUN);
    EXPECT_EQ(answer.options->scale_ppm, ALE_CLOCK_REAL);
    EXPECT_STREQ(answer.options->config.port, "/dev/ttyACM0");
    EXPECT_EQ(answer.err, "");
}

TEST(Options, TheCommandLineGoesOverTheFile)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "robot.ini";
    std::ofstream(path) << "[sensor]\nport = /dev/a\n[lcm]\nurl = memq://\n";
    const Answer answer = read({"--config", path, "--port=/dev/b", "--map", "m.txt", "--time-scale", "2.5"});
    EXPECT_EQ(answer.result, ALE_OPTIONS_RUN) << answer.err;
    EXPECT_STREQ(answer.options->config.port, "/dev/b");
    EXPECT_STREQ(answer.options->config.lcm_url, "memq://");
    EXPECT_STREQ(answer.options->config.map, "m.txt");
    EXPECT_EQ(answer.options->scale_ppm, 2500000);
}

TEST(Options, QuestionsAreAnsweredOnStdout)
{
    EXPECT_NE(read({"--help"}).out.find("--time-scale"), std::string::npos);
    EXPECT_EQ(read({"--version"}).out.rfind("ale-slamd ", 0), 0u);
    EXPECT_NE(read({"--print-config"}).out.find("[sensor]"), std::string::npos);
    EXPECT_NE(read({"--check-config"}).out.find("fine"), std::string::npos);
    for (const char *question : {"--help", "--version", "--print-config", "--check-config"}) {
        EXPECT_EQ(read({question}).result, ALE_OPTIONS_DONE);
    }
}

TEST(Options, WrongUseIsOneLineOnStderr)
{
    const std::vector<std::vector<std::string>> wrong = {
        {"--no-such-option"},
        {"--port"},
        {"stray"},
        {"--time-scale", "0"},
        {"--time-scale", "101"},
        {"--time-scale", "fast"},
        {"--config", "/no/such/file"},
        {"--keys", "/no/such/file"},
        {"--check-config", "--map", "/no/such/file"},
        {"--check-config", "--map", "/"},
        {"--port", std::string(400, 'p')},
    };
    for (const auto &words : wrong) {
        const Answer answer = read(words);
        EXPECT_EQ(answer.result, ALE_OPTIONS_REFUSED) << words[0];
        EXPECT_EQ(answer.out, "");
        EXPECT_EQ(std::count(answer.err.begin(), answer.err.end(), '\n'), 1) << answer.err;
        EXPECT_EQ(answer.err.rfind("ale-slamd: ", 0), 0u) << answer.err;
    }
}

TEST(Options, ARobotsOwnKeysAreReadWhereTheyAreNamedAndBesideItsList)
{
    const files::TemporaryFolder folder;
    const std::string list = folder / "robot.keys";
    const std::string drive = folder / "drive.key";
    const std::string ini = folder / "robot.ini";
    char error[ALE_KEYS_ERROR] = "";
    ale_keys_t keys{};
    ale_secret_key_t own{};
    ale_drive_key_t drive_key{};
    ASSERT_EQ(ale_keys_make("rover", &own, &keys.operator_key[keys.count++]), 0);
    ASSERT_EQ(ale_keys_save(list.c_str(), &keys, error), 0) << error;
    EXPECT_FALSE(read({"--keys", list}).options->vouches) << "there is none";
    ASSERT_EQ(ale_robot_key_save((list + ALE_OWN_KEY_ENDING).c_str(), &own, error), 0) << error;
    ASSERT_EQ(ale_drive_key_make(&drive_key), 0);
    ASSERT_EQ(ale_drive_key_save(drive.c_str(), &drive_key, error), 0) << error;
    const Answer beside = read({"--keys", list});
    EXPECT_EQ(beside.result, ALE_OPTIONS_RUN) << beside.err;
    EXPECT_TRUE(beside.options->vouches);
    EXPECT_FALSE(beside.options->keyed);
    EXPECT_EQ(std::memcmp(beside.options->own_key.key, own.key, sizeof own.key), 0);

    std::ofstream(ini) << "[drive]\nkey = " << drive << "\n[commands]\nown_key = " << list << ".secret\n";
    const Answer named = read({"--config", ini});
    EXPECT_EQ(named.result, ALE_OPTIONS_RUN) << named.err;
    EXPECT_TRUE(named.options->vouches && named.options->keyed);
    for (const char *wrong : {"[commands]\nown_key = /no/such", "[drive]\nkey = /no/such"}) {
        std::ofstream(ini) << wrong << "\n";
        const Answer refused = read({"--config", ini});
        EXPECT_EQ(refused.result, ALE_OPTIONS_REFUSED);
        EXPECT_NE(refused.err.find("/no/such"), std::string::npos) << refused.err;
    }
}

TEST(Options, WrongUseNamesTheWord)
{
    EXPECT_EQ(read({"--port", "/dev/x", "--nonsense"}).err,
              "ale-slamd: unknown option --nonsense (see --help)\n");
    EXPECT_EQ(read({"-x"}).err, "ale-slamd: unknown option -x (see --help)\n");
    EXPECT_EQ(read({"--check-config", "--port"}).err, "ale-slamd: --port wants a value (see --help)\n");
    EXPECT_EQ(read({"--help=3"}).err, "ale-slamd: --help takes no value (see --help)\n");
    EXPECT_EQ(read({"stray", "--port", "/dev/x"}).err, "ale-slamd: what is \"stray\"? (see --help)\n");
}

} // namespace
