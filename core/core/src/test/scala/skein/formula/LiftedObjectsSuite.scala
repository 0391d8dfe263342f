package skein.formula

import scala.compiletime.uninitialized
import skein.policy.*

/** Methods whose objects and whole numbers a formula must not take for others. */
class LiftedObjectsSuite extends munit.FunSuite:
  import LiftedObjectsSuite.*

  private def refusal(of: AnyRef): String =
    Formula.of(of, "of").fold(_.getMessage, _ => fail("it was traced"))

  private def value(of: AnyRef, x: Double): Double =
    val formula = Formula.of(of, "of").fold(throw _, identity)
    Evaluation(formula.outputs.map(_._2))(Array(x), formula.parametersOf(of))(0)

  test("a field that one branch alone writes is 0 in the other"):
    for x <- Seq(-2.0, 2.0) do
      assertEquals(value(WrittenOnce, x), WrittenOnce.of(x))
      assertEquals(value(WrittenApart, x), WrittenApart.of(x))

  test("of two arrays or objects between which a condition chose, none can be changed afterwards"):
    assert(clue(refusal(AliasedArrays)).contains("it changes one of two arrays"))
    assert(clue(refusal(AliasedObjects)).contains("it changes one of two objects"))

  test("an object that one branch chose from stays what the other branch made of it"):
    for x <- Seq(-2.0, 0.5, 2.0) do assertEquals(value(ChosenInside, x), ChosenInside.of(x))

  test("a number that is rounded to millionths is no length of time"):
    assert(clue(refusal(Rounded)).contains("it computes with nanoseconds"))

  test("a product of a remembered whole number is refused, since it may overflow; a counter is not"):
    def of(policy: Policy) = PolicyFormula.of(policy, 0, Assignment(Vector(Vector(1), Vector(0))), false)
    assert(clue(of(Congruential).left.map(_.getMessage)).left.exists(_.contains("may overflow")))
    assert(of(Counting).isRight, of(Counting).left.map(_.getMessage))

object LiftedObjectsSuite:
  private final class Pair:
    var one: Double = uninitialized
    var two: Double = uninitialized

  private object WrittenOnce:
    def of(x: Double): Double =
      val pair = Pair()
      if x > 0 then pair.one = 5
      pair.one

  private object WrittenApart:
    def of(x: Double): Double =
      val pair = Pair()
      if x > 0 then pair.one = 5 else pair.two = 7
      pair.one + 10 * pair.two

  private object AliasedArrays:
    def of(x: Double): Double =
      val (a, b) = (Array(1.0, 2), Array(3.0, 4))
      val chosen = if x > 0 then a else b
      a(0) = 9
      chosen(0)

  private object AliasedObjects:
    def of(x: Double): Double =
      val (a, b) = (Pair(), Pair())
      val chosen = if x > 0 then a else b
      a.one = 9
      chosen.one

  private object ChosenInside:
    def of(x: Double): Double =
      val (a, b) = (Pair(), Pair())
      b.one = 3
      var seen = 0.0
      if x > 0 then
        val chosen = if x > 1 then a else b
        seen = chosen.one
      else a.one = 4
      seen + a.one

  private object Rounded:
    def of(x: Double): Double = math.round(x * 1e6) / 1e6

  private object Congruential extends Policy:
    type Memory = Int
    def start: Int                                            = 1
    def choose(seen: Observation, memory: Int): (Action, Int) =
      val next = memory * 1664525 + 1013904223
      (seen.along(if next > 0 then 1 else -1, 5), next)

  private object Counting extends Policy:
    type Memory = Int
    def start: Int                                            = 0
    def choose(seen: Observation, memory: Int): (Action, Int) =
      val next = if memory > 20 then 0 else memory + 1
      (seen.along(if next > 10 then 1 else -1, 5), next)
