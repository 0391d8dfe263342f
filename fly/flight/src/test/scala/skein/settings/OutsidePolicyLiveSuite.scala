package skein.settings

import java.io.IOException
import java.net.{StandardProtocolFamily, UnixDomainSocketAddress}
import java.nio.ByteBuffer
import java.nio.channels.ServerSocketChannel
import scala.util.{Try, Using}
import skein.policy.PlanarObservation
import skein.testing.{TemporaryFolders, Unhurried}
import skein.units.{OwnFailure, Span}

class OutsidePolicyLiveSuite extends munit.FunSuite, Unhurried, TemporaryFolders:
  private def reached(file: Either[String, PolicyFile]) =
    file.map(_.policy.asInstanceOf[OutsidePolicy]).fold(fail(_), identity)

  private val seen = PlanarObservation(3, 4, 1, -2, 0.5, 1.5, 0.1, 0.02, 0.03)

  /** Decisions or failures of as many requests as there are answers. */
  private def decided(answers: Array[Byte]*): Seq[Either[String, Double]] =
    Using.resource(Peer((number, _) => answers.lift(number))): peer =>
      val policy = reached(OutsidePolicy.reach(peer.option))
      answers.map: _ =>
        Try(policy.heading(seen)).toEither.left.map:
          case reason: OwnFailure => reason.getMessage
          case other              => throw other

  test(
    "an answer is the fraction of the most that the pursuer turns, and values beyond are clipped"
  ):
    assertEquals(
      decided(Peer.number(0.5f), Peer.number(-7), Peer.number(1)),
      Seq(Right(0.5 + 0.05), Right(0.5 - 0.1), Right(0.5 + 0.1))
    )

  test(
    "with a turn rate, an answer is a fraction of it, for both roles; without, an evader turns immediately"
  ):
    def decidedBy(who: String) = Using.resource(Peer((_, _) => Some(Peer.number(0.5f)))): peer =>
      reached(OutsidePolicy.reach(peer.option.replace("pursuer", who))).heading(seen)
    assertEquals(decidedBy("pursuer@2.5"), 0.5 + 0.125)
    assertEquals(decidedBy("evader@2.5"), 0.5 + 0.125)
    assertEquals(decidedBy("evader"), 0.5 + math.Pi / 2)

  test("observations are in the frame of the vehicle's heading"):
    val straight = seen.copy(ownHeadingRad = 0).fromOwnHeading.toVector
    assertEquals(straight.take(4), Vector(3.0, 4.0, 1.0, -2.0))
    assertEquals(straight.drop(6), Vector(0.1, 0.02, 0.03))
    val east = seen.copy(ownHeadingRad = math.Pi / 2, opponentHeadingRad = math.Pi).fromOwnHeading
    for (came, expected) <- east.take(6).toSeq.zip(Seq(4.0, -3.0, -2.0, -1.0, 0.0, 1.0)) do
      assertEqualsDouble(came, expected, 1e-6)

  test("a policy that fails, or returns no number, receives further requests"):
    assertEquals(
      decided(
        Peer.refusal("no \u001b[2J\r\n such\u0007luck\n"),
        Peer.number(Float.NaN),
        Peer.number(Float.NegativeInfinity),
        Peer.number(0)
      ),
      Seq(
        Left("the policy: no  [2J  such luck"),
        Left("the policy: expected a number from -1 to 1, got NaN"),
        Left("the policy: expected a number from -1 to 1, got -Infinity"),
        Right(0.5)
      )
    )

  test("a policy that violates the protocol, or ends, receives no further requests"):
    for
      (answer, reason) <- Seq(
        Array[Byte](7)                 -> "expected 0 or 1 before an answer, got 7",
        Array[Byte](1, 1, 0, 0, 0)     -> "expected at most 65536 bytes of text, got 16777216",
        Array[Byte](1, -1, -1, -1, -1) -> "expected at most 65536 bytes of text, got -1"
      )
    do assertEquals(decided(answer, Peer.number(0)), Seq.fill(2)(Left(s"the policy: $reason")))

    Using.resource(Peer((_, _) => None)): peer =>
      val policy = reached(OutsidePolicy.reach(peer.option))
      for _ <- 1 to 2 do
        assert(intercept[OwnFailure](policy.heading(
          1, 1, 0, 0, 0, 0, 0.1
        )).getMessage.startsWith("the policy: "))
      assertEquals(peer.asked, 1)

  test("an answer without a request is not mistaken for the answer to the next request"):
    assertEquals(
      decided(Peer.number(0.5f) ++ Peer.number(-1), Peer.number(0), Peer.number(0)),
      Right(0.55) +: Seq.fill(2)(Left("the policy: expected one answer to a question, got more"))
    )

  test("a process that ends between two requests has ended, and receives no further ones"):
    val path = temporaryFolder().resolve("policy")
    Using.resource(ServerSocketChannel.open(StandardProtocolFamily.UNIX)): listener =>
      listener.bind(UnixDomainSocketAddress.of(path)): Unit
      val policy = reached(OutsidePolicy.reach(s"unix:pursuer:$path"))
      listener.accept().close()
      for _ <- 1 to 2 do
        val reason = intercept[OwnFailure](policy.heading(1, 1, 0, 0, 0, 0, 0.1)).getMessage
        assertEquals(reason, "the policy: its process has ended")

  test("connecting takes no longer than an answer may"):
    val path = temporaryFolder().resolve("policy")
    Using.resource(ServerSocketChannel.open(StandardProtocolFamily.UNIX)): listener =>
      listener.bind(UnixDomainSocketAddress.of(path), 1): Unit
      // The first ones wait in line.
      val refused = Iterator
        .continually(OutsidePolicy.reach(s"unix:pursuer:$path", Span.ofMillis(500)))
        .take(10)
        .collectFirst { case Left(reason) => reason }
      assertEquals(
        refused,
        Some(s"expected a policy behind the socket $path: it accepts nobody within 500 ms")
      )

  test("an answer that is not complete in time counts as missing, and there is no second question"):
    for part <- Seq(Array.empty[Byte], Array[Byte](0, 0)) do
      Using.resource(Peer((_, _) => Some(part))): peer =>
        val policy = reached(OutsidePolicy.reach(peer.option, Span.ofMillis(30)))
        for _ <- 1 to 2 do
          val reason = intercept[OwnFailure](policy.heading(1, 1, 0, 0, 0, 0, 0.1)).getMessage
          assertEquals(reason, "the policy: expected an answer within 30 ms, got none")
        assert(peer.asked <= 1)

  test("a question that the process does not read in time fails"):
    val path = temporaryFolder().resolve("policy")
    Using.resource(ServerSocketChannel.open(StandardProtocolFamily.UNIX)): listener =>
      listener.bind(UnixDomainSocketAddress.of(path)): Unit
      Using.resource(ProcessSocket(path.toString, Span.ofMillis(30))): socket =>
        val reason = intercept[IOException](socket.ask(ByteBuffer.allocate(64 << 20))).getMessage
        assertEquals(reason, "expected an answer within 30 ms, got none")

  test("an address without a process is refused, with what was expected"):
    val nobody = OutsidePolicy.reach("unix:pursuer:/nowhere/policy").left.toOption
    assert(nobody.exists(_.startsWith("expected a policy behind the socket /nowhere/policy: ")), nobody)
    assertEquals(
      OutsidePolicy.reach("unix:judge:/nowhere"),
      Left("unix:judge:/nowhere: expected pursuer or evader, got 'judge'")
    )
    assertEquals(
      OutsidePolicy.reach("unix:pursuer"),
      Left("expected unix:ROLE:PATH, or unix:ROLE@RATE:PATH, got 'unix:pursuer'")
    )
    for rate <- Seq("51", "0", "fast", "NaN") do
      assertEquals(
        OutsidePolicy.reach(s"unix:evader@$rate:/nowhere"),
        Left(s"unix:evader@$rate:/nowhere: expected a turn rate from 0.001 to 50.0 rad/s, got '$rate'")
      )
