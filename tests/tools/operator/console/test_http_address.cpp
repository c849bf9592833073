// Where the console listens and which pages may talk to it.
#include "common/command_line/wrong_use.h"
#include "operator/console/http_address.h"

#include <set>
#include <stdexcept>
#include <string>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <gtest/gtest.h>

using console::origin_is_ours;
using console::parse_http_address;

TEST(HttpAddress, AddressAndPortAreTakenApart)
{
    const auto address = parse_http_address("127.0.0.1:8080");
    EXPECT_EQ(address.host, "127.0.0.1");
    EXPECT_EQ(address.port, 8080);
    EXPECT_EQ(address.url(), "http://127.0.0.1:8080/");
}

TEST(HttpAddress, AnIpv6AddressWearsBrackets)
{
    const auto address = parse_http_address("[::1]:90");
    EXPECT_EQ(address.host, "::1");
    EXPECT_TRUE(address.ipv6);
    EXPECT_EQ(address.url(), "http://[::1]:90/");
}

TEST(HttpAddress, WhatIsNoAddressIsRefusedWithItsName)
{
    for (const char *text : {"", ":80", "127.0.0.1", "127.0.0.1:", "127.0.0.1:-1", "127.0.0.1:65536",
                             "127.0.0.1:8 ", "127.0.0.1:0x50", "127.0.0.1:99999999999999999999"}) {
        try {
            parse_http_address(text);
            ADD_FAILURE() << text;
        } catch (const cli::WrongUse &error) {
            EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
        }
    }
}

TEST(HttpAddress, ThePageOfThisConsoleIsOurs)
{
    EXPECT_TRUE(origin_is_ours("http://127.0.0.1:8080", "127.0.0.1:8080", {"http", "robot", ""}));
    EXPECT_TRUE(origin_is_ours("http://[::1]:8080", "[::1]:8080", {"http", "robot", ""}));
    EXPECT_TRUE(origin_is_ours("http://localhost:8080", "localhost:8080", {"http", "robot", ""}));
    EXPECT_TRUE(origin_is_ours("http://192.168.1.7", "192.168.1.7", {"http", "robot", ""}));
    EXPECT_TRUE(origin_is_ours("http://robot:8080", "robot:8080", {"http", "robot", ""}));
    EXPECT_TRUE(origin_is_ours("http://robot.local:8080", "robot.local:8080", {"http", "robot", ""}));
}

TEST(HttpAddress, AProgramThatIsNoBrowserHasNoOrigin)
{
    EXPECT_TRUE(origin_is_ours("", "127.0.0.1:8080", {"http", "robot", ""}));
}

TEST(HttpAddress, AForeignPageIsNotOurs)
{
    EXPECT_FALSE(origin_is_ours("http://evil.example", "127.0.0.1:8080", {"http", "robot", ""}));
    EXPECT_FALSE(origin_is_ours("http://127.0.0.1:8081", "127.0.0.1:8080", {"http", "robot", ""}));
    EXPECT_FALSE(origin_is_ours("https://127.0.0.1:8080", "127.0.0.1:8080", {"http", "robot", ""}));
    EXPECT_FALSE(
        origin_is_ours("http://127.0.0.1:8080.evil.example", "127.0.0.1:8080", {"http", "robot", ""}));
    EXPECT_FALSE(origin_is_ours("null", "127.0.0.1:8080", {"http", "robot", ""}));
    EXPECT_FALSE(origin_is_ours("file://", "127.0.0.1:8080", {"http", "robot", ""}));
}

TEST(HttpAddress, AForeignNameMadeToResolveToUsIsNotOurs)
{
    EXPECT_FALSE(origin_is_ours("http://evil.example:8080", "evil.example:8080", {"http", "robot", ""}));
    EXPECT_FALSE(origin_is_ours("http://robot.evil.example", "robot.evil.example", {"http", "robot", ""}));
    EXPECT_FALSE(origin_is_ours("http://:8080", ":8080", {"http", "", ""}));
}

TEST(HttpAddress, APageServedOverTlsIsOursOverTlsOnly)
{
    const console::Ours ours = {"https", "robot", ""};
    EXPECT_TRUE(origin_is_ours("https://127.0.0.1:8080", "127.0.0.1:8080", ours));
    EXPECT_FALSE(origin_is_ours("http://127.0.0.1:8080", "127.0.0.1:8080", ours));
}

TEST(HttpAddress, WhatAProxyShowsIsOursWhateverItMakesOfTheHost)
{
    const console::Ours ours = {"http", "robot", "https://robot.example"};
    EXPECT_TRUE(origin_is_ours("https://robot.example", "127.0.0.1:8080", ours));
    EXPECT_TRUE(origin_is_ours("https://robot.example", "robot.example", ours));
    EXPECT_FALSE(origin_is_ours("https://robot.example.evil.example", "robot.example", ours));
    EXPECT_FALSE(origin_is_ours("http://robot.example", "robot.example", ours));
}

TEST(HttpAddress, AnOriginIsASchemeAndAHost)
{
    console::check_origin("https://robot.example");
    console::check_origin("http://robot:8080");
    for (const char *text :
         {"", "robot.example", "https://", "https://robot.example/", "ftp://robot", "https://a b"}) {
        EXPECT_THROW(console::check_origin(text), cli::WrongUse) << text;
    }
}

TEST(HttpAddress, LoopbackIsWhatOnlyThisMachineReaches)
{
    for (const char *text : {"127.0.0.1:1", "127.3.2.1:1", "localhost:1", "[::1]:1"}) {
        EXPECT_TRUE(console::is_loopback(console::parse_http_address(text))) << text;
    }
    for (const char *text : {"0.0.0.0:1", "192.168.1.2:1", "[::]:1"}) {
        EXPECT_FALSE(console::is_loopback(console::parse_http_address(text))) << text;
    }
}

TEST(HttpAddress, WhatStandsForAllAddressesIsToldAsOneThatOthersCanType)
{
    for (const char *text : {"127.0.0.1:80", "192.168.1.2:81", "[::1]:82"}) {
        const console::HttpAddress address = console::parse_http_address(text);
        EXPECT_EQ(console::reachable(address).url(), address.url());
    }
    ifaddrs *first = nullptr;
    ASSERT_EQ(getifaddrs(&first), 0);
    std::set<std::string> own; // of this machine, for others
    for (const ifaddrs *one = first; one != nullptr; one = one->ifa_next) {
        if (one->ifa_addr != nullptr && one->ifa_addr->sa_family == AF_INET &&
            (one->ifa_flags & IFF_LOOPBACK) == 0 && (one->ifa_flags & IFF_UP) != 0) {
            char text[INET_ADDRSTRLEN] = "";
            inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in *>(one->ifa_addr)->sin_addr, text,
                      sizeof text);
            own.insert(text);
        }
    }
    freeifaddrs(first);
    const console::HttpAddress told = console::reachable(console::parse_http_address("0.0.0.0:83"));
    EXPECT_EQ(told.port, 83);
    EXPECT_TRUE(own.empty() ? told.host == "0.0.0.0" : own.count(told.host) == 1) << told.host;
}
