#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <memory>
#include <pthread.h>
#include <pty.h>
#include <string>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "files.hpp"

extern "C" {
#include "serial/port.h"
#include "serial/port_candidates.h"
}

namespace fs = std::filesystem;

namespace
{

// A pseudo terminal: the test holds the far end.
class Port : public testing::Test
{
  protected:
    int far = -1;
    std::string name;
    ale_port_t *port = nullptr;

    void SetUp() override
    {
        int near = -1;
        char text[128];
        ASSERT_EQ(openpty(&far, &near, text, nullptr, nullptr), 0);
        close(near);
        name = text;
    }
    void TearDown() override
    {
        ale_port_close(port);
        hang_up();
    }
    void hang_up()
    {
        if (far >= 0) {
            close(far);
            far = -1;
        }
    }
    void open()
    {
        ASSERT_EQ(ale_port_open(&port, name.c_str(), 115200), ALE_PORT_OK);
    }
    void send(const std::string &bytes) const
    {
        ASSERT_EQ(write(far, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    }
    std::string receive(size_t count)
    {
        std::string out;
        while (out.size() < count && ale_port_wait(port, 60000) == 1) {
            uint8_t bytes[256];
            const int got = ale_port_read(port, bytes, sizeof bytes);
            if (got < 0) {
                break;
            }
            out.append(bytes, bytes + got);
        }
        return out;
    }
};

TEST_F(Port, all_256_bytes_pass_unchanged_in_both_directions)
{
    open();
    std::string all;
    for (int c = 0; c < 256; c++) {
        all += static_cast<char>(c);
    }
    send(all);
    EXPECT_EQ(receive(256), all);
    ASSERT_EQ(ale_port_write(port, reinterpret_cast<const uint8_t *>(all.data()), all.size(), 1000),
              ALE_PORT_OK);
    std::string back(256, '\0');
    for (size_t got = 0; got < 256;) {
        const ssize_t n = read(far, back.data() + got, 256 - got);
        ASSERT_GT(n, 0);
        got += static_cast<size_t>(n);
    }
    EXPECT_EQ(back, all);
}

TEST_F(Port, reading_does_not_wait_and_waiting_ends)
{
    open();
    uint8_t byte = 0;
    EXPECT_EQ(ale_port_read(port, &byte, 1), 0);
    EXPECT_EQ(ale_port_wait(port, 20), 0);
    send("x");
    EXPECT_EQ(ale_port_wait(port, 60000), 1);
    EXPECT_EQ(ale_port_wait(nullptr, 1), 0);
}

TEST_F(Port, link_to_the_device_is_followed)
{
    const files::TemporaryFolder folder;
    const fs::path link = folder.path() / "urg";
    fs::create_symlink(name, link);
    ASSERT_EQ(ale_port_open(&port, link.c_str(), 19200), ALE_PORT_OK);
    EXPECT_FALSE(ale_port_has_baud(port));
    send("hello");
    EXPECT_EQ(receive(5), "hello");
}

TEST_F(Port, rate_of_every_scanner_can_be_set_also_those_without_a_constant)
{
    open();
    for (const int32_t baud : {19200, 38400, 57600, 115200, 250000, 500000, 750000}) {
        EXPECT_EQ(ale_port_set_baud(port, baud), ALE_PORT_OK) << baud;
    }
    EXPECT_EQ(ale_port_set_baud(port, 0), ALE_PORT_BAUD);
}

TEST_F(Port, port_has_one_owner)
{
    open();
    ale_port_t *second = nullptr;
    EXPECT_EQ(ale_port_open(&second, name.c_str(), 115200), ALE_PORT_BUSY);
    EXPECT_EQ(second, nullptr);
    ale_port_close(port);
    port = nullptr;
    EXPECT_EQ(ale_port_open(&port, name.c_str(), 115200), ALE_PORT_OK) << "free again";
}

TEST_F(Port, second_owner_disturbs_nothing_and_is_told_of_the_first)
{
    open();
    send("hello");
    EXPECT_EQ(ale_port_wait(port, 60000), 1);
    const pid_t other = fork();
    if (other == 0) {
        ale_port_t *second = nullptr;
        char words[ALE_PORT_WORDS] = "";
        const int status = ale_port_open(&second, name.c_str(), 19200);
        ale_port_explain(status, name.c_str(), words);
        const std::string expected = "in use by another program: process " + std::to_string(getppid());
        _exit(status == ALE_PORT_BUSY && std::string(words).rfind(expected, 0) == 0 ? 0 : 1);
    }
    int ended = -1;
    ASSERT_EQ(waitpid(other, &ended, 0), other);
    EXPECT_EQ(ended, 0);
    EXPECT_EQ(receive(5), "hello") << "what was waiting is still there";
}

TEST_F(Port, unplugged_port_is_gone_and_stays_gone)
{
    open();
    hang_up();
    uint8_t byte = 0;
    EXPECT_NE(ale_port_wait(port, 60000), 0) << "told at once, not at the end of the wait";
    EXPECT_EQ(ale_port_read(port, &byte, 1), ALE_PORT_GONE);
    EXPECT_EQ(ale_port_read(port, &byte, 1), ALE_PORT_GONE);
    EXPECT_EQ(ale_port_write(port, &byte, 1, 100), ALE_PORT_GONE);
}

TEST_F(Port, write_that_nobody_takes_ends_with_its_time)
{
    open();
    const std::string much(1 << 20, 'x');
    EXPECT_EQ(ale_port_write(port, reinterpret_cast<const uint8_t *>(much.data()), much.size(), 30),
              ALE_PORT_TIMEOUT);
}

TEST_F(Port, signals_do_not_end_a_wait)
{
    open();
    struct sigaction action = {};
    struct sigaction before = {};
    action.sa_handler = [](int) {};
    sigaction(SIGUSR1, &action, &before);
    int waited = -99;
    std::thread waiter([&] { waited = ale_port_wait(port, 60000); });
    for (int k = 0; k < 5; k++) {
        pthread_kill(waiter.native_handle(), SIGUSR1);
        usleep(1000);
    }
    send("x");
    waiter.join();
    EXPECT_EQ(waited, 1);
    sigaction(SIGUSR1, &before, nullptr);
}

TEST(PortOpen, what_is_no_serial_device_is_named)
{
    const files::TemporaryFolder folder;
    ale_port_t *port = nullptr;
    EXPECT_EQ(ale_port_open(&port, (folder.path() / "nothing").c_str(), 115200), ALE_PORT_ABSENT);
    EXPECT_EQ(ale_port_open(&port, folder.path().c_str(), 115200), ALE_PORT_FOLDER);
    std::ofstream(folder.path() / "drive.scip") << "bytes";
    EXPECT_EQ(ale_port_open(&port, (folder.path() / "drive.scip").c_str(), 115200), ALE_PORT_FILE);
    EXPECT_EQ(ale_port_open(&port, "/dev/null", 115200), ALE_PORT_OTHER);
    for (int status = ALE_PORT_BUSY; status <= ALE_PORT_OK; status++) {
        EXPECT_STRNE(ale_port_strerror(status), ale_port_strerror(1));
    }
}

// libserialport is for what the kernel lists; the virtual console is such a terminal on most machines.
TEST(PortOpen, terminal_that_the_kernel_lists_is_opened_by_libserialport)
{
    const char *const consoles[] = {"/dev/ttyS0", "/dev/tty63"};
    for (const char *console : consoles) {
        ale_port_t *port = nullptr;
        if (ale_port_open(&port, console, 115200) != ALE_PORT_OK) {
            continue;
        }
        EXPECT_TRUE(ale_port_has_baud(port));
        uint8_t byte = 0;
        EXPECT_EQ(ale_port_read(port, &byte, 1), 0);
        EXPECT_EQ(ale_port_wait(port, 1), 0);
        ale_port_close(port);
        return;
    }
    GTEST_SKIP() << "needs a terminal that may be opened: " << consoles[0] << " or " << consoles[1];
}

TEST(PortCandidates, stable_names_come_first_and_no_device_twice)
{
    const files::TemporaryFolder dev;
    char paths[ALE_PORT_CANDIDATES][ALE_PORT_PATH];
    EXPECT_EQ(ale_port_candidates(dev.path().c_str(), paths), 0U);
    fs::create_directories(dev.path() / "serial/by-id");
    for (const char *name : {"ttyACM1", "ttyACM0", "ttyUSB0", "ttyS0", "null"}) {
        close(::open((dev.path() / name).c_str(), O_CREAT | O_WRONLY, 0600));
    }
    fs::create_symlink("../../ttyACM1", dev.path() / "serial/by-id/usb-Hokuyo");
    ASSERT_EQ(ale_port_candidates(dev.path().c_str(), paths), 3U);
    EXPECT_EQ(paths[0], (dev.path() / "serial/by-id/usb-Hokuyo").string());
    EXPECT_EQ(paths[1], (dev.path() / "ttyACM0").string());
    EXPECT_EQ(paths[2], (dev.path() / "ttyUSB0").string());
}

} // namespace
