#include <gtest/gtest.h>

#include "common/command_line/command_line.h"

extern "C" {
#include "base/version.h"
}

namespace
{

struct Said {
    int code;
    std::string out;
    std::string err;
};

struct Values {
    bool once = false;
    bool odometry = true;
    std::string url;
    std::vector<std::string> maps;
    double speed = 1;
    uint64_t seed = 1;
    char side = 'm';
    std::string log;
    std::string other;
    int worked = 0;
};

Said answer(cli::CommandLine &line, std::vector<std::string> words, const std::function<int()> &work)
{
    words.insert(words.begin(), "some/path/ale-test");
    std::vector<char *> argv;
    for (std::string &word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = line.run(static_cast<int>(words.size()), argv.data(), work);
    std::string out = testing::internal::GetCapturedStdout();
    return {code, out, testing::internal::GetCapturedStderr()};
}

Said run(Values &v, const std::vector<std::string> &words, int result = 0)
{
    cli::CommandLine line("ale-test", "usage: ale-test\n");
    line.flag("once", v.once);
    line.flag("no-odometry", v.odometry, false);
    line.text("lcm-url", v.url);
    line.texts("map", v.maps);
    line.number("speed", v.speed, 0.01, 1000.0);
    line.number("seed", v.seed, uint64_t{0}, uint64_t{4000000000});
    line.choice("side", v.side, cli::Choices<char>{{"left", 'l'}, {"right", 'r'}});
    line.argument("LOG", v.log);
    line.possible_argument("OTHER", v.other);
    return answer(line, words, [&] {
        v.worked++;
        return result;
    });
}

TEST(CommandLine, options_and_words_reach_their_values_in_any_order)
{
    Values v;
    const Said said =
        run(v, {"--once", "a.log", "--map", "a.png", "--no-odometry", "b.log", "--map=b.svg", "--speed",
                "2.5", "--seed", "4000000000", "--side", "right", "--lcm-url", "udpm://"});
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(v.worked, 1);
    EXPECT_TRUE(v.once);
    EXPECT_FALSE(v.odometry);
    EXPECT_EQ(v.url, "udpm://");
    EXPECT_EQ(v.maps, (std::vector<std::string>{"a.png", "b.svg"}));
    EXPECT_EQ(v.speed, 2.5);
    EXPECT_EQ(v.seed, 4000000000u);
    EXPECT_EQ(v.side, 'r');
    EXPECT_EQ(v.log, "a.log");
    EXPECT_EQ(v.other, "b.log");
}

TEST(CommandLine, what_is_not_said_stays_and_the_work_gives_the_exit_code)
{
    Values v;
    EXPECT_EQ(run(v, {"a.log"}, 7).code, 7);
    EXPECT_EQ(v.speed, 1);
    EXPECT_TRUE(v.odometry);
    EXPECT_EQ(v.other, "");
}

TEST(CommandLine, work_without_an_exit_code_of_its_own_is_fine_when_it_returns)
{
    bool worked = false;
    char name[] = "ale-test";
    char *argv[] = {name, nullptr};
    EXPECT_EQ(cli::CommandLine("ale-test", "").run(1, argv, [&] { worked = true; }), 0);
    EXPECT_TRUE(worked);
}

TEST(CommandLine, help_and_version_are_answered_without_work)
{
    Values v;
    for (const auto &[word, text] : {std::pair<std::string, std::string>{"--help", "usage: ale-test\n"},
                                     {"--version", "ale-test " ALE_VERSION "\n"}}) {
        const Said said = run(v, {word});
        EXPECT_EQ(said.code, 0);
        EXPECT_EQ(said.out, text);
        EXPECT_EQ(said.err, "");
    }
    EXPECT_EQ(v.worked, 0);
}

TEST(CommandLine, wrong_use_is_one_line_that_names_it_and_exit_code_2)
{
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{}, "LOG is missing"},
        {{"a", "b", "c"}, "what is \"c\"?"},
        {{"a", "--bogus"}, "unknown option --bogus"},
        {{"a", "--bogus=3"}, "unknown option --bogus=3"},
        {{"a", "--s", "1"}, "unknown option --s"},
        {{"a", "-x"}, "unknown option -x"},
        {{"a", "-1"}, "unknown option -1"},
        {{"a", "--once=yes"}, "--once takes no value"},
        {{"a", "--speed"}, "--speed wants a value"},
        {{"a", "--lcm-url", ""}, "--lcm-url wants a value"},
        {{"a", "--speed", "0"}, "--speed 0: expected a number from 0.01 to 1000"},
        {{"a", "--speed", "nan"}, "--speed nan: expected a number"},
        {{"a", "--speed", "1x"}, "--speed 1x: expected a number"},
        {{"a", "--seed", "-1"}, "--seed -1: expected a whole number from 0 to 4000000000"},
        {{"a", "--seed", "1.5"}, "--seed 1.5: expected a whole number"},
        {{"a", "--seed", "99999999999999999999"}, "--seed 99999999999999999999: expected"},
        {{"a", "--side", "up"}, "--side up: there are left, right"},
    };
    for (const auto &[words, message] : cases) {
        Values v;
        const Said said = run(v, words);
        EXPECT_EQ(said.code, 2) << message;
        EXPECT_EQ(said.err.rfind("ale-test: " + message, 0), 0u) << said.err;
        EXPECT_EQ(said.err.find('\n'), said.err.size() - 1) << said.err;
        EXPECT_EQ(said.out, "");
        EXPECT_EQ(v.worked, 0);
    }
}

TEST(CommandLine, what_the_work_throws_is_told_and_gives_the_exit_code)
{
    for (const bool wrong : {false, true}) {
        cli::CommandLine line("ale-test", "");
        const Said said = answer(line, {}, [&]() -> int {
            if (wrong) {
                throw cli::WrongUse("these two do not go together");
            }
            throw std::runtime_error("a.log: No such file or directory");
        });
        EXPECT_EQ(said.code, wrong ? 2 : 1);
        EXPECT_EQ(said.err, wrong ? "ale-test: these two do not go together (see --help)\n"
                                  : "ale-test: a.log: No such file or directory\n");
    }
}

TEST(CommandLine, behind_the_first_word_of_the_rest_nothing_is_an_option)
{
    std::vector<std::string> words;
    bool once = false;
    cli::CommandLine line("ale-test", "");
    line.flag("once", once);
    line.rest(words);
    EXPECT_EQ(answer(line, {"--once", "drive", "-0.3", "--once"}, [] { return 0; }).code, 0);
    EXPECT_TRUE(once);
    EXPECT_EQ(words, (std::vector<std::string>{"drive", "-0.3", "--once"}));
}

TEST(Words, a_mounting_is_three_numbers_in_their_ranges)
{
    const cli::Mounting at = cli::mounting_of("--sensor", "0.12,-0.03,1.5");
    EXPECT_EQ(at.x_m, 0.12);
    EXPECT_EQ(at.y_m, -0.03);
    EXPECT_EQ(at.theta_rad, 1.5);
    for (const char *wrong : {"", "1", "1,2", "1,2,3,4", "1,2,", "a,2,3", "101,0,0", "0,0,3.2"}) {
        EXPECT_THROW(cli::mounting_of("--sensor", wrong), cli::WrongUse) << wrong;
    }
}

} // namespace
