package skein.rpc

import skein.units.*

class PatienceSuite extends munit.FunSuite:
  private val limits = ServerLimits(
    messageTime = Span.ofSeconds(10),
    replyTime = Span.ofSeconds(30),
    silence = Span.ofSeconds(5),
    idle = Span.ofSeconds(100)
  )

  /** Number of watches until it ends, and the reason. */
  private def lasts(watch: Int => Option[(ServerLimit, String)]): (Int, ServerLimit, String) =
    Iterator
      .from(1)
      .map(i => watch(i).map((limit, why) => (i, limit, why)))
      .collectFirst { case Some(end) => end }
      .get

  test("a message may take its whole time limit, whether its bytes trickle in or not"):
    for trickles <- Seq(true, false) do
      val patience = Patience(limits)
      val end      = lasts: _ =>
        if trickles then patience.came()
        patience.watch(forMessage = true, forTaking = false, forNothing = false)
      assertEquals(end, (11, ServerLimit.Time, "a message under way for more than 10 s"))

  test("consecutive messages may together take longer than the time limit of one"):
    val patience = Patience(limits)
    for i <- 1 to 1000 do
      if i % 9 == 0 then patience.completed()
      assertEquals(patience.watch(forMessage = true, forTaking = false, forNothing = false), None)

  test("while the server itself is not reading, no message is late"):
    val patience = Patience(limits)
    for i <- 1 to 1000 do
      assertEquals(patience.watch(forMessage = i % 9 != 0, forTaking = false, forNothing = false), None)

  test("replies may wait for as long as their time limit, which restarts whenever some are taken"):
    val patience = Patience(limits)
    for _ <- 1 to 25 do patience.watch(forMessage = false, forTaking = true, forNothing = false)
    patience.taken()
    val end = lasts(_ => patience.watch(forMessage = false, forTaking = true, forNothing = false))
    assertEquals(end, (31, ServerLimit.Time, "replies not taken for more than 30 s"))

  test("replies are not late if all are taken at least once within their time limit"):
    val patience = Patience(limits)
    for i <- 1 to 1000 do
      assertEquals(patience.watch(forMessage = false, forTaking = i % 31 != 0, forNothing = false), None)

  test("limits accept their smallest allowed values, and nothing smaller"):
    val least = ServerLimits(
      inFlightPerConnection = 1,
      inFlightAssured = 1,
      inFlightInCommon = 0,
      unsentBytesPerConnection = 1,
      connections = 1,
      heldBytesPerConnection = 1,
      heldBytesInCommon = 0,
      strays = 0
    )
    for none <- Seq[ServerLimits => ServerLimits](
        _.copy(inFlightPerConnection = 0),
        _.copy(inFlightAssured = 0),
        _.copy(inFlightInCommon = -1),
        _.copy(unsentBytesPerConnection = 0),
        _.copy(connections = 0),
        _.copy(heldBytesPerConnection = 0),
        _.copy(heldBytesInCommon = -1),
        _.copy(strays = -1)
      )
    do intercept[IllegalArgumentException](none(least)): Unit

  test("silence is counted while nothing is in progress, until bytes are received"):
    val patience = Patience(limits)
    def quiet()  = patience.watch(forMessage = false, forTaking = false, forNothing = true)
    for _ <- 1 to 7 do quiet()
    assertEquals(patience.silentFor, Span.ofSeconds(7))
    patience.came()
    assertEquals(patience.silentFor, Span.Zero)
    quiet()
    patience.watch(forMessage = false, forTaking = false, forNothing = false)
    assertEquals(patience.silentFor, Span.Zero)
    assertEquals(lasts(_ => quiet()), (101, ServerLimit.Idle, "silent for more than 100 s"))
