package skein.rpc

import scala.util.Random

class CallLinesSuite extends munit.FunSuite:

  private def drain[A](lines: CallLines[A]): Seq[A] =
    Iterator.continually(lines.take()).takeWhile(_.nonEmpty).flatten.toSeq

  test("the first call of each connection is taken in turn, then its further calls in order"):
    val lines = CallLines[String]()
    for (connection, call) <- Seq(1 -> "a1", 1 -> "a2", 1 -> "a3", 2 -> "b1", 3 -> "c1", 3 -> "c2") do
      lines.put(connection, call)
    assertEquals(drain(lines), Seq("a1", "b1", "c1", "a2", "a3", "c2"))
    assert(lines.isEmpty)

  test("a call waits for at most one call of each of 200 other connections, however many they make"):
    for seed <- 1 to 20 do
      val random  = Random(seed)
      val lines   = CallLines[Long]()
      val waiting = 300
      for connection <- 1L to 200L; _ <- 1 to waiting do lines.put(connection, connection)
      for _ <- 1 to random.nextInt(1000) do lines.take()
      lines.put(0, 0)
      val ahead = Iterator.continually(lines.take()).takeWhile(!_.contains(0L)).size
      assert(ahead <= 200, s"$ahead calls went ahead, seed $seed")

  test(
    "a client that calls rarely goes ahead of 200 constantly calling ones, which wake once for several " +
      "answers"
  ):
    for pause <- Seq(60, 200, 1000) do
      val lines = CallLines[Long]()
      for connection <- 1L to 200L; _ <- 1 to 256 do lines.put(connection, connection)
      for _ <- 1 to 200; taken <- lines.take() do lines.put(taken, taken) // in order of arrival
      var last   = -1L
      var wakes  = 0
      val served = new Array[Int](201)
      for asked <- 1 to 300 do
        for i <- 0 to pause do
          if i == pause then lines.put(0, 0)
          val taken = lines.take().get
          if i == pause then assertEquals(taken, 0L, s"call $asked, pause $pause")
          served(taken.toInt) += 1
          if taken != last then wakes += 1
          last = taken
          if taken > 0 then lines.put(taken, taken)
      val others = served.drop(1)
      assert(others.max - others.min <= 6, s"from ${others.min} to ${others.max}, pause $pause")
      assert(wakes < served.sum * 0.31, s"$wakes wakes for ${served.sum} calls, pause $pause")

  test("a client that calls as fast as it can gets its share and no more"):
    val lines = CallLines[Long]()
    for connection <- 1L to 20L; _ <- 1 to 256 do lines.put(connection, connection)
    val served = new Array[Int](21)
    lines.put(0, 0)
    for _ <- 1 to 20_000 do
      val taken = lines.take().get.toInt
      served(taken) += 1
      lines.put(taken, taken)
    assert(served(0) <= 4.1 * served.drop(1).min, served.toSeq)
    assert(served.drop(1).min > 800, served.toSeq)

  test("the calls of a closed connection are dropped and counted; calls of other connections stay queued"):
    val lines = CallLines[String]()
    for connection <- 1L to 2L; i <- 1 to 3 do lines.put(connection, s"$connection-$i")
    assertEquals(lines.take(), Some("1-1"))
    lines.forget(1)
    assertEquals(drain(lines), Seq("2-1", "2-2", "2-3"))
    assertEquals(lines.dropped, 2L)
    lines.forget(7)
    lines.put(1, "again")
    assertEquals(drain(lines), Seq("again"))

  test("calls added by several threads are all taken, in order for each connection"):
    val lines   = CallLines[(Long, Int)]()
    val each    = 20_000
    val threads =
      for connection <- 1L to 4L yield Thread.ofPlatform().start: () =>
        for i <- 1 to each do lines.put(connection, connection -> i)
    val taken = Seq.newBuilder[(Long, Int)]
    var count = 0
    while count < 4 * each do
      for call <- lines.take() do
        taken += call
        count += 1
    threads.foreach(_.join())
    for (connection, calls) <- taken.result().groupMap(_._1)(_._2) do
      assertEquals(calls, 1 to each, s"connection $connection")

  test("an urgent call is taken first, with the calls of its connection that it supersedes"):
    val lines = CallLines[String](isUrgent = _.startsWith("!"))
    for call <- Seq("move a", "read", "!hover a", "move b") do lines.put(1, call)
    for call <- Seq("move a", "!ping") do lines.put(2, call)
    def urgent() = lines.takeUrgent((control, other) => control == "!hover a" && other == "move a")
    assertEquals(urgent(), Some(("!hover a", Vector("move a"))))
    assert(lines.hasUrgent)
    assertEquals(urgent(), Some(("!ping", Vector.empty)))
    assert(!lines.hasUrgent)
    assertEquals(urgent(), None)
    assertEquals(drain(lines).toSet, Set("read", "move b", "move a"))

  test("an urgent call that was already taken in its turn, or was forgotten, is not taken again"):
    val lines = CallLines[String](isUrgent = _ => true)
    lines.put(1, "a")
    lines.put(2, "b")
    assertEquals(lines.take(), Some("a"))
    lines.forget(2)
    assertEquals(lines.takeUrgent((_, _) => false), None)
    assert(!lines.hasUrgent && lines.isEmpty || drain(lines).isEmpty)
