#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

extern "C" {
#include "system/service.h"
}

namespace
{

/* What systemd would be: a datagram socket in the abstract space. */
class Service : public testing::Test
{
  protected:
    void SetUp() override
    {
        listener = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        ASSERT_EQ(bind(listener, reinterpret_cast<sockaddr *>(&address), sizeof(sa_family_t)), 0);
        socklen_t bytes = sizeof address;
        getsockname(listener, reinterpret_cast<sockaddr *>(&address), &bytes);
        const std::string name(address.sun_path + 1, bytes - sizeof(sa_family_t) - 1);
        setenv("NOTIFY_SOCKET", ("@" + name).c_str(), 1);
        setenv("WATCHDOG_USEC", "4000000", 1);
        ale_service_open(&service);
    }
    void TearDown() override
    {
        ale_service_close(&service);
        close(listener);
        unsetenv("NOTIFY_SOCKET");
        unsetenv("WATCHDOG_USEC");
    }
    std::string heard() const
    {
        char text[200];
        const ssize_t count = recv(listener, text, sizeof text, 0);
        return count < 0 ? "" : std::string(text, static_cast<size_t>(count));
    }

    int listener = -1;
    ale_service_t service{};
};

constexpr int64_t kSecond = 1000000000;

TEST_F(Service, WordsArriveAsTheyAre)
{
    ale_service_tell(&service, "READY=1");
    EXPECT_EQ(heard(), "READY=1");
    EXPECT_EQ(heard(), "");
}

TEST_F(Service, TheWatchdogIsFedFourTimesAPeriodWhileTheTaskGoesOn)
{
    int feeds = 0;
    for (int64_t k = 0; k < 400; k++) { /* forty seconds, a look a tenth */
        ale_service_feed(&service, static_cast<uint32_t>(k + 1), k * kSecond / 10);
        feeds += heard() == "WATCHDOG=1";
    }
    EXPECT_EQ(feeds, 40);
}

TEST_F(Service, ATaskThatHangsStarvesTheWatchdog)
{
    ale_service_feed(&service, 1, 0);
    EXPECT_EQ(heard(), "WATCHDOG=1");
    for (int64_t k = 1; k < 100; k++) {
        ale_service_feed(&service, 1, k * kSecond);
        EXPECT_EQ(heard(), "");
    }
    ale_service_feed(&service, 2, 100 * kSecond);
    EXPECT_EQ(heard(), "WATCHDOG=1");
}

TEST_F(Service, WithoutSystemdNothingIsSent)
{
    ale_service_t alone;
    unsetenv("NOTIFY_SOCKET");
    ale_service_open(&alone);
    ale_service_tell(&alone, "READY=1");
    ale_service_feed(&alone, 1, 0);
    EXPECT_EQ(heard(), "");
    setenv("NOTIFY_SOCKET", std::string(300, 'x').c_str(), 1);
    ale_service_open(&alone);
    EXPECT_EQ(alone.socket, -1);
}

} // namespace
