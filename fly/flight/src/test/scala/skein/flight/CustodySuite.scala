package skein.flight

import skein.flight.Custody.{Held, Known}

class CustodySuite extends munit.FunSuite:
  private def taken(answers: Vector[Held]*) =
    answers.foldLeft((Known(), Option.empty[String])) { case ((known, _), next) => known.heard(next) }._2

  private val flies  = Vector(Held("a", true, Some(true)), Held("b", true, Some(true)))
  private val landed = Vector(Held("a", true, Some(true)), Held("b", true, Some(false)))

  test("vehicles that fly under API control belong to the flight"):
    assertEquals(taken(flies, flies, flies), None)

  test("a vehicle without API control is lost, and the reason names it"):
    val without = Vector(Held("a", true, Some(true)), Held("b", false, Some(true)))
    assert(taken(flies, without).exists(_.startsWith("no longer gives b to this flight")))

  test("a vehicle that has landed is lost after two such answers in a row"):
    assertEquals(taken(flies, landed), None)
    assertEquals(taken(flies, landed, flies, landed), None)
    assert(taken(flies, landed, landed).exists(_.contains("b has landed")))

  test("landing is not detected by a simulator that never reports flying, and cars need not fly"):
    assertEquals(taken(landed, landed, landed), None)
    val car = Vector(Held("car", true, None))
    assertEquals(taken(car, car), None)
