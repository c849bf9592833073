// The token and its file.
#include "operator/console/token.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "files.hpp"

using console::token_of_file;

namespace
{

class TokenFile : public testing::Test
{
  protected:
    std::string refusal() const
    {
        try {
            token_of_file(path_);
        } catch (const std::runtime_error &error) {
            return error.what();
        }
        return "";
    }
    void write(const std::string &text, mode_t rights = 0600) const
    {
        std::ofstream(path_) << text;
        chmod(path_.c_str(), rights);
    }

    const files::TemporaryFolder folder_;
    const std::string path_ = folder_ / "console.token";
};

TEST_F(TokenFile, IsMadeForItsOwnerAloneAndStays)
{
    const std::string token = token_of_file(path_);
    struct stat status = {};
    ASSERT_EQ(stat(path_.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777U, 0600U);
    EXPECT_TRUE(console::is_token(token));
    EXPECT_EQ(token_of_file(path_), token);
    EXPECT_NE(console::random_token(), console::random_token());
}

TEST_F(TokenFile, MayBeWrittenByHand)
{
    write("abcdefghijkl1\n");
    EXPECT_EQ(token_of_file(path_), "abcdefghijkl1");
}

TEST_F(TokenFile, IsRefusedWithItsNameAndTheReason)
{
    write("abcdefghijkl1\n", 0640);
    EXPECT_EQ(refusal(), path_ + ": readable by others: no longer secret (chmod 600)");
    for (const std::string &text :
         {std::string("short"), std::string("not a token here"), std::string(300, 'x')}) {
        write(text);
        EXPECT_EQ(refusal().rfind(path_ + ": ", 0), 0U) << refusal();
    }
    unlink(path_.c_str());
    ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
    EXPECT_EQ(refusal(), path_ + ": no regular file");
}

TEST_F(TokenFile, OfAnotherUserIsRefused)
{
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can give a file away";
    }
    write("abcdefghijkl1\n");
    ASSERT_EQ(chown(path_.c_str(), 65534, 65534), 0);
    EXPECT_NE(refusal().find("belongs to another user"), std::string::npos) << refusal();
}

TEST(Token, IsHiddenInTheArguments)
{
    std::vector<std::string> words = {"ale-console", "--token", "abcdefghijkl1", "--tok=abcdefghijkl1",
                                      "--http"};
    std::vector<char *> arguments;
    for (std::string &word : words) {
        arguments.push_back(word.data());
    }
    console::hide_in_arguments("abcdefghijkl1", static_cast<int>(arguments.size()), arguments.data());
    EXPECT_EQ(words, (std::vector<std::string>{"ale-console", "--token", "*************",
                                               "--tok=*************", "--http"}));
}

} // namespace
