package skein.record

import skein.units.*

class DifferenceSuite extends munit.FunSuite:
  private val one = Samples.reading(1)

  test(
    "equal recordings do not differ, and of different ones the first differing row and column are reported"
  ):
    assertEquals(Difference.first(Samples.oneOfEach, Samples.oneOfEach), None)
    val later = one.copy(state = one.state.copy(sentAt = one.state.sentAt + Span.ofNanos(1)))
    val found = Difference.first(Seq(Samples.decision(1), one), Seq(Samples.decision(1), later))
    assertEquals(found.map(_.where), Some(s"reading 1 of ${one.vehicle}"))
    assertEquals(
      found.map(seen => (seen.column, seen.recorded, seen.again)),
      Some(("sentAtNs", one.state.sentAt.toNanos.toString, later.state.sentAt.toNanos.toString))
    )

  test("a missing or additional row is reported"):
    val two = Samples.reading(2)
    assertEquals(
      Difference.first(Seq(one, two), Seq(one)),
      Some(Difference(s"reading 2 of ${one.vehicle}", "the row", "there", "missing"))
    )
    assertEquals(
      Difference.first(Seq(one), Seq(one, two)),
      Some(Difference(s"reading 2 of ${one.vehicle}", "the row", "missing", "there"))
    )

  test("a row of another table is a difference, whatever its values"):
    val event = Event(Instant.Epoch, EventKind.Dropped, None, "x")
    assertEquals(Difference.between(one, event).map(_.column), Some("the table"))

  test(
    "a recorder counts the records that it was offered in each table, in addition to those of the heading"
  ):
    val recorder = MemoryRecorder(Samples.heading)
    for number <- 1 to 5 do recorder.offer(Samples.reading(number))
    recorder.offer(Samples.decision(1))
    val written = recorder.close().value.map(_.get).flatMap(_.toOption).getOrElse(fail("not closed"))
    assertEquals(written.rows("reading"), 5L)
    assertEquals(written.rows("decision"), 1L)
    assertEquals(written.total, Samples.heading.records.size + 6L)
