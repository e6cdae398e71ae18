// The commands for every host of the workshop: they talk to services and need no library for point
// clouds or images.
#include <array>

#include "services/ctl/line/command.h"

namespace chorus::ctl {
namespace {

constexpr std::array kHostCommands{
    Command{
        "init", "Writes the configuration of a service, or a certificate for it",
        "Examples:\n"
        "  chorus init sensor --id s1 --device bridge\n"
        "  chorus init fusion --sensor s1=http://10.0.0.11:8081/,TOKEN --output vrpn=10.0.0.20\n"
        "  chorus init sensor --ask               asks for what matters\n"
        "  chorus init fusion --out -             only shows it\n"
        "  chorus init ca                         an authority for the hosts of a workshop\n"
        "  chorus init certificate s1.local 10.0.0.11 --out s1   for one of them, into folder s1\n"
        "  chorus init site --name hall --cell a --cell b   a server by which cells meet\n"
        "  chorus init site --join a.json         this fusion server becomes cell a\n"
        "An existing file is never overwritten, but --join adds to one.  Then: systemctl restart "
        "chorus-SERVICE.",
        &add_init},
    Command{"discover", "Lists the sensors that announce themselves in this network",
            "Examples:\n"
            "  chorus discover\n"
            "  chorus discover --json | jq -r '.[].url'\n"
            "  chorus init fusion --discover          all of them in a new configuration\n"
            "By multicast DNS with Avahi (avahi-daemon, avahi-utils).  Tokens are not announced.\n"
            "Exit code 0: at least one was found; 1: none, or no Avahi here.",
            &add_discover},
    Command{"doctor", "Checks this host: clock, services, tokens, disk, and the way to each sensor",
            "Examples:\n"
            "  chorus doctor\n"
            "  chorus doctor --json | jq '.findings[] | select(.good | not)'\n"
            "Exit code 0: all is well; 1: something is not, and what to do about it is printed.",
            &add_doctor},
    Command{
        "register", "Finds where the sensors stand, from a person who walks through the room",
        "Examples:\n"
        "  chorus register                        walk through the room until it says so\n"
        "  chorus register --seconds 45 --fresh   forget what is known first\n"
        "  chorus register --cancel               end the session that runs\n"
        "  chorus register --json | jq .verdict\n"
        "A session that has started by itself is joined.  The verdict is this walk's own.\n"
        "Exit code 0: good or provisional, in use, and every sensor that took part has a "
        "place;\n"
        "1: refused, or a sensor is left without a place (the reasons are printed), cancelled,\n"
        "nobody walked, or no server; 130: Ctrl-C, and the session goes on.",
        &add_register},
    Command{"origin", "Says where the world begins and where its front is",
            "Examples:\n"
            "  chorus origin                          shows where it is now\n"
            "  chorus origin --here                   stand there, face the front\n"
            "  chorus origin --points                 stand there, then ahead, then on the left\n"
            "  chorus origin --stand=0,0 --stand=0,2.5   stand on marks of the world to be\n"
            "  chorus origin --mark=1.2,3.4=0,0 --mark=1.3,5.9=0,2.5   where marks are, shall be\n"
            "  chorus origin --x 1.5 --z -2           by numbers, in the world as it is\n"
            "  chorus origin --yaw 90                 turns the world and leaves its origin\n"
            "The world then stays: over new walks, another master, and restarts.",
            &add_origin},
    Command{
        "status", "Shows the sensors, the registration and the fused bodies of a fusion server",
        "Examples:\n"
        "  chorus status\n"
        "  chorus status --url http://127.0.0.1:8080/ --json | jq .sensors\n"
        "Where chorus-evaluation judges the tracker by worn sensors, it says which limb is off.\n"
        "Exit code 0: at least one sensor is live; 1: none is, or no server.",
        &add_status},
    Command{"record", "Records a running sensor or fusion server into a file on this machine",
            "Examples:\n"
            "  chorus record --out walk.mcap --seconds 60\n"
            "  chorus record http://10.0.0.5:8080/ --out walk.mcap        until Ctrl-C\n"
            "  chorus record http://10.0.0.5:8081/ --out s1.mcap          one sensor alone\n"
            "Everything a fusion server needs to do its work again: raw frames, clock models,\n"
            "registration; and its fused frames.  Then: chorus fuse walk.mcap --out fused.mcap.",
            &add_record},
    Command{"mark", "Names the present in the recording that a fusion server is making",
            "Examples:\n"
            "  chorus mark 'takes the drill'\n"
            "  chorus mark lift --url http://10.0.0.5:8080/\n"
            "The mark is kept in the recording.  Phases of a task begin and end at marks:\n"
            "docs/guide/ergonomics.md.",
            &add_mark},
    Command{"camera", "Shows the webcams of this host",
            "Examples:\n"
            "  chorus camera list\n"
            "  chorus camera list --json | jq -r .[0].source\n"
            "Then: chorus-sensor --camera /dev/video0 (docs/guide/cameras.md).",
            &add_camera},
};

}  // namespace

std::span<const Command> host_commands() { return kHostCommands; }

}  // namespace chorus::ctl
