package skein.solver

import skein.loop.{Memory, TeamView}
import skein.units.*

class DeskSuite extends munit.FunSuite:
  private def asked(number: Long, used: Option[(Long, Long)] = None, vehicle: Int = 0) = Question(
    7,
    Vector((vehicle = vehicle, memory = Memory(0, None, number))),
    number,
    Instant.Epoch,
    None,
    used.map((solver, question) => (solver = solver, question = question)),
    TeamView.empty(2)
  )

  private def offered(desk: Desk, questions: Question*) =
    questions.foldLeft(desk)(_.offered(_, Instant.Epoch))

  test("of waiting requests the newest is decided; older and repeated ones are skipped"):
    val desk = offered(Desk.of(2), asked(0), asked(2), asked(1), asked(2))
    assertEquals((desk.overtaken, desk.repeated), (2L, 1L))
    val (taken, work) = desk.taken(0)
    assertEquals(work.map(_.question.number), Some(2L))
    assertEquals(taken.taken(0)._2, None)

  test("each vehicle has one decision in progress, independent of other vehicles"):
    val (busy, _) = offered(Desk.of(2), asked(0)).taken(0)
    val more      = offered(busy, asked(1), asked(2), asked(0, vehicle = 1))
    assertEquals(more.taken(0)._2, None)
    assertEquals(more.taken(1)._2.map(_.question.vehicle), Some(1))
    val free = more.done(asked(0), Some("a"))
    assertEquals(free.taken(0)._2.map(_.question.number), Some(2L))

  test("a request continues from the answer that was used, not from the last answer given"):
    val desk = Desk.of(2).done(asked(0), Some("a")).done(asked(1, Some((1, 0))), Some("b"))
    assertEquals(desk.memory(asked(2, Some((1, 0))), solver = 1), Some("a"))
    assertEquals(desk.memory(asked(2, Some((1, 1))), solver = 1), Some("b"))
    assertEquals(desk.memory(asked(2), solver = 1), None)
    assertEquals(desk.memory(asked(2, Some((9, 1))), solver = 1), None)

  test("the number of memories is limited, and the last used one is kept"):
    val desk = (1L to 500L).foldLeft(Desk.of(2).done(asked(0), Some(0L))): (desk, number) =>
      desk.done(asked(number, Some((1, 0))), Some(number))
    assert(desk.vehicles(0).memories.size <= Desk.MostMemories + 1)
    assertEquals(desk.memory(asked(501, Some((1, 0))), solver = 1), Some(0L))
    assertEquals(desk.memory(asked(501, Some((1, 499))), solver = 1), Some(499L))
    val next = desk.done(asked(501, Some((1, 499))), Some(501L))
    assertEquals(next.vehicles(0).memories.keySet, Set(499L, 500L, 501L))
