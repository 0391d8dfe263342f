package skein.flight

import skein.flight.Custody.{Held, Known}

class CustodySuite extends munit.FunSuite:
  private def taken(answers: Vector[Held]*) =
    answers.foldLeft((Known(), Option.empty[String])) { case ((known, _), next) => known.heard(next) }._2

  private val flies  = Vector(Held("a", true, Some(true)), Held("b", true, Some(true)))
  private val landed = Vector(Held("a", true, Some(true)), Held("b", true, Some(false)))

  test("vehicles that fly under api control are the flight's"):
    assertEquals(taken(flies, flies, flies), None)

  test("one without api control is not, and is named"):
    val without = Vector(Held("a", true, Some(true)), Held("b", false, Some(true)))
    assert(taken(flies, without).exists(_.startsWith("no longer gives b to this flight")))

  test("one that has landed is not, once two answers in a row say so"):
    assertEquals(taken(flies, landed), None)
    assertEquals(taken(flies, landed, flies, landed), None)
    assert(taken(flies, landed, landed).exists(_.contains("b has landed")))

  test("a simulator that never says that a vehicle flies does not know, and cars need not fly"):
    assertEquals(taken(landed, landed, landed), None)
    val car = Vector(Held("car", true, None))
    assertEquals(taken(car, car), None)
