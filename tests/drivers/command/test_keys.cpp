#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <string>
#include <sys/stat.h>
#include <unistd.h>

#include "drivers/command/signed_command.hpp"
#include "files.hpp"

using signed_command::Operator;

namespace
{

class Keys : public testing::Test
{
  protected:
    void write_robot(const std::string &text)
    {
        std::ofstream(robot) << text;
    }
    std::string refusal_of(const std::string &text)
    {
        write_robot(text);
        return refusal();
    }
    std::string refusal()
    {
        return ale_keys_load(robot.c_str(), &keys, error) < 0 ? error : "";
    }

    const files::TemporaryFolder folder;
    const std::string robot = folder / "robot.keys";
    const std::string own = folder / "alice.key";
    ale_keys_t keys{};
    char error[ALE_KEYS_ERROR] = "";
    const Operator alice{"alice"};
};

TEST_F(Keys, ComeBackFromTheirFilesAsTheyWere)
{
    ale_keys_t made{};
    made.operator_key[made.count++] = alice.known;
    made.operator_key[made.count++] = Operator("bob-2.x_Y").known;
    ASSERT_EQ(ale_keys_save(robot.c_str(), &made, error), 0) << error;
    ASSERT_EQ(ale_keys_load(robot.c_str(), &keys, error), 0) << error;
    EXPECT_EQ(std::memcmp(&keys, &made, sizeof keys), 0);
    ale_secret_key_t secret{};
    ASSERT_EQ(ale_secret_key_save(own.c_str(), &alice.secret, error), 0) << error;
    ASSERT_EQ(ale_secret_key_load(own.c_str(), &secret, error), 0) << error;
    EXPECT_EQ(std::memcmp(&secret, &alice.secret, sizeof secret), 0);
}

TEST_F(Keys, OfRobotsAndMotorControllersComeBackAndAreNotTakenForOthers)
{
    const Operator rover("rover");
    ale_keys_t known{};
    ale_keys_t again{};
    known.operator_key[known.count++] = rover.known;
    const std::string list = folder / "alice.key.robots";
    const std::string own_key = folder / "robot.keys.secret";
    const std::string drive = folder / "drive.key";
    ASSERT_EQ(ale_robots_save(list.c_str(), &known, error), 0) << error;
    ASSERT_EQ(ale_robots_load(list.c_str(), &again, error), 0) << error;
    EXPECT_EQ(std::memcmp(&again, &known, sizeof again), 0);
    EXPECT_LT(ale_keys_load(list.c_str(), &again, error), 0) << "no list of operators";
    ale_secret_key_t secret{};
    ASSERT_EQ(ale_robot_key_save(own_key.c_str(), &rover.secret, error), 0) << error;
    ASSERT_EQ(ale_robot_key_load(own_key.c_str(), &secret, error), 0) << error;
    EXPECT_EQ(std::memcmp(&secret, &rover.secret, sizeof secret), 0);
    EXPECT_LT(ale_secret_key_load(own_key.c_str(), &secret, error), 0) << "no operator's";
    const ale_public_key_t half = ale_public_half(&secret);
    EXPECT_EQ(std::memcmp(&half, &rover.known, sizeof half), 0);
    ale_drive_key_t made{};
    ale_drive_key_t read{};
    ASSERT_EQ(ale_drive_key_make(&made), 0);
    ASSERT_EQ(ale_drive_key_save(drive.c_str(), &made, error), 0) << error;
    ASSERT_EQ(ale_drive_key_load(drive.c_str(), &read, error), 0) << error;
    EXPECT_EQ(std::memcmp(&made, &read, sizeof made), 0);
    EXPECT_LT(ale_robot_key_load(drive.c_str(), &secret, error), 0);
}

TEST_F(Keys, APublicKeyGoesThroughALineOfText)
{
    char text[ALE_PUBLIC_KEY_TEXT];
    ale_public_key_text(&alice.known, text);
    ale_public_key_t again{};
    ASSERT_EQ(ale_public_key_parse(text, &again), 0) << text;
    EXPECT_EQ(std::memcmp(&again, &alice.known, sizeof again), 0);
    for (const char *wrong : {"", "alice", "alice 12", "alice zz"}) {
        EXPECT_LT(ale_public_key_parse(wrong, &again), 0) << wrong;
    }
}

TEST_F(Keys, ASecretKeyIsForItsOwnerAloneAndNeverWrittenOver)
{
    ASSERT_EQ(ale_secret_key_save(own.c_str(), &alice.secret, error), 0) << error;
    struct stat file;
    ASSERT_EQ(stat(own.c_str(), &file), 0);
    EXPECT_EQ(file.st_mode & 0777U, 0600U);
    EXPECT_LT(ale_secret_key_save(own.c_str(), &alice.secret, error), 0);
    chmod(own.c_str(), 0640);
    ale_secret_key_t secret{};
    EXPECT_LT(ale_secret_key_load(own.c_str(), &secret, error), 0);
    EXPECT_NE(std::string(error).find("alice.key: readable by others"), std::string::npos) << error;
}

TEST_F(Keys, AListThatOthersMayChangeIsRefused)
{
    write_robot("ALE-SLAM keys 1\n");
    EXPECT_EQ(refusal(), "");
    for (const mode_t rights : {0666U, 0664U, 0646U}) {
        chmod(robot.c_str(), rights);
        EXPECT_NE(refusal().find("robot.keys: writable by others"), std::string::npos) << refusal();
    }
}

TEST_F(Keys, FilesOfAnotherUserAreRefused)
{
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can give a file away";
    }
    write_robot("ALE-SLAM keys 1\n");
    ASSERT_EQ(ale_secret_key_save(own.c_str(), &alice.secret, error), 0) << error;
    ASSERT_EQ(chown(robot.c_str(), 65534, 0), 0);
    ASSERT_EQ(chown(own.c_str(), 65534, 0), 0);
    EXPECT_NE(refusal().find("robot.keys: belongs to another user"), std::string::npos) << refusal();
    ale_secret_key_t secret{};
    EXPECT_LT(ale_secret_key_load(own.c_str(), &secret, error), 0);
    EXPECT_NE(std::string(error).find("alice.key: belongs to another user"), std::string::npos) << error;
}

/* As the service's is, which root has made and given away. */
TEST_F(Keys, TheRobotsOwnKeyIsReadByRootThoughItIsTheServices)
{
    if (geteuid() != 0) {
        GTEST_SKIP() << "only root can give a file away";
    }
    ASSERT_EQ(ale_robot_key_save(own.c_str(), &alice.secret, error), 0) << error;
    ASSERT_EQ(chown(own.c_str(), 65534, 0), 0);
    ale_secret_key_t secret{};
    EXPECT_EQ(ale_robot_key_load(own.c_str(), &secret, error), 0) << error;
}

TEST_F(Keys, APipeIsNoFileOfKeysAndHoldsNobodyUp)
{
    ASSERT_EQ(mkfifo(robot.c_str(), 0600), 0);
    EXPECT_NE(refusal().find("robot.keys: no regular file"), std::string::npos) << refusal();
}

TEST_F(Keys, WhatIsNoListIsRefusedWithItsLine)
{
    const std::string hex(64, '0');
    const std::string one = "0100000000000000000000000000000000000000000000000000000000000000";
    ale_keys_t made{};
    made.operator_key[made.count++] = alice.known;
    ASSERT_EQ(ale_keys_save(robot.c_str(), &made, error), 0);
    std::ifstream saved(robot);
    const std::string good{std::istreambuf_iterator<char>(saved), {}};
    const std::string line = good.substr(good.find("alice"));
    EXPECT_NE(refusal_of(""), "");
    EXPECT_NE(refusal_of("ALE-SLAM operator key 1\n"), "");
    EXPECT_NE(refusal_of("ALE-SLAM keys 1\nalice\n").find(":2: not a name"), std::string::npos);
    EXPECT_NE(refusal_of("ALE-SLAM keys 1\nal/ice " + hex).find(":2: not a name"), std::string::npos);
    EXPECT_NE(refusal_of("ALE-SLAM keys 1\nalice"), "");
    EXPECT_NE(refusal_of("ALE-SLAM keys 1\nalice 12").find(":2: "), std::string::npos);
    EXPECT_NE(refusal_of("ALE-SLAM keys 1\nalice " + one).find("safe"), std::string::npos);
    EXPECT_NE(refusal_of("ALE-SLAM keys 1\n" + line + line).find(":3: a name"), std::string::npos);
    EXPECT_EQ(refusal_of("ALE-SLAM keys 1\n\n# nobody\n" + line), "");
    EXPECT_EQ(keys.count, 1U);
}

TEST_F(Keys, ANameIsShortAndPlain)
{
    for (const char *name : {"", "a b", "../x", "\xc3\xa4", "0123456789012345678901234567890123"}) {
        EXPECT_FALSE(ale_is_name(name)) << name;
    }
    EXPECT_TRUE(ale_is_name("Anna-2.b_c"));
}

} // namespace
