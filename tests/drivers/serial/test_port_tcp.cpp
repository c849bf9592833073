// drivers/serial: a scanner on Ethernet, and what is said where none is.
#include <string>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

extern "C" {
#include "serial/port.h"
}

namespace
{

// A TCP port of this computer; the test is the scanner.
class PortTcp : public testing::Test
{
  protected:
    int listener = -1;
    int scanner = -1;
    std::string path;
    ale_port_t *port = nullptr;

    void SetUp() override
    {
        listener = socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        auto *any = reinterpret_cast<sockaddr *>(&address);
        ASSERT_EQ(bind(listener, any, size), 0);
        ASSERT_EQ(listen(listener, 1), 0);
        ASSERT_EQ(getsockname(listener, any, &size), 0);
        path = "tcp:127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    }
    void TearDown() override
    {
        ale_port_close(port);
        close(listener);
        if (scanner >= 0) {
            close(scanner);
        }
    }
    void connect()
    {
        ASSERT_EQ(ale_port_open(&port, path.c_str(), 115200), ALE_PORT_OK);
        scanner = accept(listener, nullptr, nullptr);
        ASSERT_GE(scanner, 0);
    }
};

TEST_F(PortTcp, BytesGoBothWays)
{
    connect();
    EXPECT_FALSE(ale_port_has_baud(port));
    uint8_t bytes[8] = {};
    EXPECT_EQ(ale_port_read(port, bytes, sizeof bytes), 0) << "none are there yet";
    EXPECT_EQ(ale_port_wait(port, 1), 0);
    ASSERT_EQ(write(scanner, "00P\n", 4), 4);
    EXPECT_EQ(ale_port_wait(port, 5000), 1);
    EXPECT_EQ(ale_port_read(port, bytes, sizeof bytes), 4);
    const uint8_t command[] = {'Q', 'T', '\n'};
    EXPECT_EQ(ale_port_write(port, command, sizeof command, 1000), ALE_PORT_OK);
    EXPECT_EQ(read(scanner, bytes, sizeof bytes), 3);
    EXPECT_EQ(ale_port_set_baud(port, 115200), ALE_PORT_BAUD);
    EXPECT_EQ(ale_port_set_dtr(port, false), ALE_PORT_OTHER);
}

TEST_F(PortTcp, AnEndedConnectionIsAPortThatIsGone)
{
    connect();
    close(scanner);
    scanner = -1;
    uint8_t byte = 0;
    ale_port_wait(port, 5000);
    EXPECT_EQ(ale_port_read(port, &byte, 1), ALE_PORT_GONE);
}

TEST_F(PortTcp, ARefusedConnectionIsNamed)
{
    close(listener);
    listener = socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_EQ(ale_port_open(&port, path.c_str(), 0), ALE_PORT_REFUSED);
    char words[ALE_PORT_WORDS];
    ale_port_explain(ALE_PORT_REFUSED, path.c_str(), words);
    EXPECT_STREQ(words, "connection refused: a computer is there, but nobody listens at this port");
}

TEST_F(PortTcp, WhatIsNoAddressIsNamed)
{
    for (const char *wrong : {"tcp:", "tcp::10940", "tcp:scanner.local:10940", "tcp:127.0.0.1:port",
                              "tcp:127.0.0.1:1:2", "tcp:[::1", "tcp:300.1.1.1:10940"}) {
        EXPECT_EQ(ale_port_open(&port, wrong, 0), ALE_PORT_ADDRESS) << wrong;
    }
}

TEST(PortTcpStatus, EachHasWordsOfItsOwn)
{
    for (int status = ALE_PORT_UNANSWERED; status < ALE_PORT_OK; status++) {
        EXPECT_STRNE(ale_port_strerror(status), "unknown status");
        EXPECT_LT(std::string(ale_port_strerror(status)).size(), size_t{ALE_PORT_WORDS});
    }
}

} // namespace
