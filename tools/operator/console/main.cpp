/* ale-console: the operator's page. LCM in on a thread for each robot, the web on another, the boards between
 * them. */
#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <sodium.h>
#include <unistd.h>

#include "common/command_line/command_line.h"
#include "operator/console/fleet.h"
#include "operator/console/http_address.h"
#include "operator/console/robot.h"
#include "operator/console/token.h"
#include "operator/console/web_server.h"

namespace
{

constexpr char usage[] =
    "usage: ale-console [--lcm-url URL]... [--http ADDR:PORT] [--keys FILE] [--robots FILE]\n"
    "                   [--robot NAME]... [--recordings DIR]... [--flights DIR]... [--maps DIR]...\n"
    "                   [--token-file FILE] [--cert FILE --key FILE] [--origin URL]\n"
    "The operator's console: serves a web page that shows what the robot publishes over LCM and commands "
    "it.\n"
    "  --lcm-url URL     where the robot publishes (default: LCM_DEFAULT_URL, else LCM's own default); for\n"
    "                    several robots once for each, and --robot, --recordings and so on in the same "
    "order\n"
    "  --http ADDR:PORT  where the page is served (default 127.0.0.1:8080; port 0: any free one)\n"
    "  --keys FILE       the operator's key (ale-keys makes it); without it the page only watches\n"
    "  --robots FILE     the robots whose word is believed (default: the file of --keys with .robots "
    "behind)\n"
    "  --robot NAME      which robot is shown and commanded; needed where more than one is heard\n"
    "  --recordings DIR  where the page's recordings are written (LCM logs); without it none are made\n"
    "  --flights DIR     flight recordings that the page shows: [recorder] folder of the robot; others "
    "(.scip) "
    "may\n"
    "                    lie in the folder of --recordings\n"
    "  --maps DIR        saved maps that the page shows: [map] folder of the robot, where the console runs "
    "on it\n"
    "  --token-file FILE the token: who has it in the address may open the page. Made when it is not there\n"
    "                    (default ~/.local/state/ale-slam/console.token)\n"
    "  --token TEXT      the same on the command line, where others on this machine may see it\n"
    "  --cert FILE       certificate (PEM) and\n"
    "  --key FILE        its key: the page is served over TLS\n"
    "  --origin URL      the page is shown by a proxy at https://HOST[:PORT]\n"
    "  --help, --version\n"
    "Prints the page's address on stdout. Ends with Ctrl-C or SIGTERM. Exit: 0 fine, 1 failed, 2 wrong "
    "use.\n";

struct Options {
    console::FleetOptions fleet;
    std::string http = "127.0.0.1:8080";
    std::string token;
    std::string token_file;
    std::string certificate;
    std::string key;
    std::string proxy;
};

/* The token that is asked for: on the loopback, too, because others may be logged in on this machine. */
std::string token_for(const Options &options)
{
    if (!options.token.empty()) {
        return options.token;
    }
    const std::string file = options.token_file.empty() ? console::usual_token_file() : options.token_file;
    if (file.empty()) {
        return console::random_token();
    }
    try {
        return console::token_of_file(file);
    } catch (const std::runtime_error &error) {
        if (!options.token_file.empty()) {
            throw;
        }
        std::fprintf(stderr, "ale-console: %s; a token for this time alone\n", error.what());
        return console::random_token();
    }
}

/* What is open to others though it works. */
void warn(const Options &options, const console::HttpAddress &address)
{
    if (!options.token.empty()) {
        std::fputs("ale-console: others on this machine may have seen the token on the command line; "
                   "--token-file keeps it to yourself\n",
                   stderr);
    }
    if (!console::is_loopback(address) && options.certificate.empty() && options.proxy.empty()) {
        std::fputs("ale-console: this page is not encrypted: who listens on the network learns the token "
                   "(--cert and --key, or a tunnel)\n",
                   stderr);
    }
}

/* Blocked before any thread exists, so that all inherit it and only sigwait sees them. */
sigset_t block_endings()
{
    sigset_t endings;
    sigemptyset(&endings);
    sigaddset(&endings, SIGINT);
    sigaddset(&endings, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &endings, nullptr);
    return endings;
}

void check(const Options &options)
{
    if (!options.token.empty() && !console::is_token(options.token)) {
        throw cli::WrongUse("--token wants 12 to 128 letters and digits");
    }
    if (!options.token.empty() && !options.token_file.empty()) {
        throw cli::WrongUse("--token or --token-file, not both");
    }
    if (options.certificate.empty() != options.key.empty()) {
        throw cli::WrongUse("--cert and --key belong together");
    }
    if (!options.proxy.empty()) {
        console::check_origin(options.proxy);
    }
    if (sodium_init() < 0) {
        throw std::runtime_error("no random numbers on this machine");
    }
}

/* Hears one robot until all is to stop. Who can no longer hear it ends the console. */
void follow(console::Robot &robot, const std::atomic<bool> &stopping, std::atomic<bool> &failed)
{
    try {
        robot.follow(stopping);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "ale-console: %s\n", error.what());
        failed = true;
        kill(getpid(), SIGTERM);
    }
}

void run(const Options &options, const sigset_t &endings)
{
    const console::HttpAddress address = console::parse_http_address(options.http);
    console::Fleet fleet(console::settings_of(options.fleet));
    console::WebServer server(fleet,
                              {address, token_for(options), options.certificate, options.key, options.proxy});
    warn(options, address);
    std::printf("%s\n", server.url().c_str());
    std::fflush(stdout);

    std::atomic<bool> stopping{false};
    std::atomic<bool> failed{false};
    std::vector<std::thread> threads;
    threads.emplace_back([&] { server.run(); });
    for (console::Robot &robot : fleet.robots()) {
        threads.emplace_back([&] { follow(robot, stopping, failed); });
    }
    int signal = 0;
    sigwait(&endings, &signal);
    stopping = true;
    server.stop();
    for (std::thread &thread : threads) {
        thread.join();
    }
    if (failed) {
        throw std::runtime_error("ended because the robot's messages can no longer be received");
    }
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    cli::CommandLine line("ale-console", usage);
    line.texts("lcm-url", options.fleet.lcm_urls);
    line.text("http", options.http);
    line.text("token", options.token);
    line.text("token-file", options.token_file);
    line.text("cert", options.certificate);
    line.text("key", options.key);
    line.text("origin", options.proxy);
    line.texts("recordings", options.fleet.recordings);
    line.texts("flights", options.fleet.flights);
    line.texts("maps", options.fleet.maps);
    line.text("keys", options.fleet.key_file);
    line.text("robots", options.fleet.robots_file);
    line.texts("robot", options.fleet.robots);
    return line.run(argc, argv, [&] {
        check(options);
        if (!options.token.empty()) {
            console::hide_in_arguments(options.token, argc, argv);
        }
        const sigset_t endings = block_endings();
        std::signal(SIGPIPE, SIG_IGN);
        run(options, endings);
    });
}
