package skein.cli

import skein.rpc.{ServerLimits, ServerStats}
import skein.simulator.PeerStats

class ServerNewsSuite extends munit.FunSuite:
  private val calm = ServerStats(3, 3, 0, 0, 0, 0, 0, 0, 100, 0, 100, 0, 0, 0, 0, 500, 3 << 20)

  test("while no client's request is refused, nothing is printed"):
    assertEquals(ServerNews.line(calm, ServerLimits()), None)

  test("losses of MAVLink peers are printed, too"):
    assertEquals(
      ServerNews.line(
        calm,
        ServerLimits(),
        PeerStats(damaged = 3, dropped = 2, turnedAway = 1, ignored = 9)
      ),
      Some(
        "MAVLink: 3 damaged frames, 2 datagrams dropped for peers too slow, 1 peers turned away, " +
          "9 datagrams ignored, of too many peers or too many at once"
      )
    )

  test("each kind of refusal is counted and described, with the held memory"):
    val limits = ServerLimits(connections = 4, heldBytesPerConnection = 1 << 20, heldBytesInCommon = 2 << 20)
    assertEquals(
      ServerNews.line(calm.copy(turnedAway = 2, tooSlow = 1, dropped = 7), limits),
      Some(
        "clients: 2 turned away because 4 connections were open, 1 closed for " +
          "messages or replies that took too long; 7 calls of closed connections " +
          "dropped; at most 3 of 10 MiB were held for clients at any time"
      )
    )

  test("lost lockstep, foreign connections and moves that occupy all workers are printed"):
    assertEquals(
      ServerNews.line(calm, ServerLimits(), PeerStats(unanswered = 1, foreign = 2), "px4", hasHeldUp = true),
      Some(
        "px4: 2 connections closed that spoke another protocol, 1 times lockstep lost for want of an answer " +
          "within a second; time goes on without it; moves have held all workers for too long: from now on no " +
          "call waits behind them, and the newest move of a vehicle wins immediately"
      )
    )
