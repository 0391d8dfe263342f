package skein.rpc

import org.apache.pekko.actor.ActorSystem
import skein.link.PreciseScheduler

/** Mutated sequences over loopback sockets; a short version of [[Fuzz]]. */
class FuzzLiveSuite extends munit.FunSuite:
  private given system: ActorSystem = ActorSystem("rpc-fuzz", PreciseScheduler.config)

  override def afterAll(): Unit =
    val _ = system.terminate()

  test(
    "the server closes 300 connections with mutated bytes for the right reasons, and serves others meanwhile"
  ):
    val figures = PairFuzz.server(300, seed = 1)
    assertEquals(figures.healthy, 300L)
    assert(figures.closedWithReason > 50, s"$figures")

  test("each call with one of 300 mutated answers ends, with a result only if it was sent for that call"):
    val figures = PairFuzz.client(300, seed = 1)
    assert(figures.right > 30 && figures.refused > 3 && figures.failed > 50, s"$figures")
