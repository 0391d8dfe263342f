package skein.port

import org.scalacheck.Gen
import org.scalacheck.Prop.forAll
import skein.policy.Action
import skein.units.*

class PlanBufferLaws extends munit.ScalaCheckSuite:

  private def ms(time: Int) = Instant.Epoch + Span.ofMillis(time)

  /** A plan with an action every 100 ms from `firstMs` on. The actions contain the numbers of plan and
    * moment.
    */
  private final case class Sent(sequence: Long, firstMs: Int, count: Int):
    def actions: Vector[(at: Instant, action: (Long, Int))] =
      Vector.tabulate(count)(number => (at = ms(firstMs + 100 * number), action = (sequence, number)))

  private type Buffer = PlanBuffer[(Long, Int)]
  private val empty: Buffer = PlanBuffer.empty

  extension (buffer: Buffer)
    private def receive(plan: Sent, nowMs: Int = 0): Buffer =
      buffer.received(plan.sequence, plan.actions, ms(nowMs))
    private def dueAt(time: Int) = buffer.due(ms(time)).map(_.action)

  private val plans = Gen.listOfN(
    6,
    for
      late  <- Gen.choose(0, 80)
      count <- Gen.choose(1, CommandPlan.Most)
    yield (late, count)
  ).map(_.zipWithIndex.map { case ((late, count), index) => Sent(index, 1000 + 100 * index + late, count) })

  private val times = Gen.choose(900, 4000)

  property("whatever the order and number of arrivals, the newest plan decides from its first time on"):
    forAll(plans, Gen.listOfN(20, Gen.choose(0, 5)), times): (plans, order, time) =>
      val last   = plans.last
      val buffer = order.map(plans(_)).foldLeft(empty)(_.receive(_)).receive(last)
      time < last.firstMs || buffer.dueAt(time) == empty.receive(last).dueAt(time)

  property("a plan that is older, or that arrives again, changes nothing"):
    forAll(plans, Gen.choose(0, 5)): (plans, again) =>
      val buffer = plans.foldLeft(empty)(_.receive(_))
      buffer.receive(plans(again)) == buffer

  property("an older plan continues until the first time of a newer one"):
    forAll(plans, times): (plans, time) =>
      val (older, newer) = (empty.receive(plans.head), empty.receive(plans.head).receive(plans(1)))
      time >= plans(1).firstMs || newer.dueAt(time) == older.dueAt(time)

  property("after a lost plan, its predecessor's action for each time acts"):
    forAll(plans.suchThat(_.head.count > 2), times): (plans, time) =>
      val first = plans.head
      val due   = empty.receive(first).dueAt(time).map(_._2)
      due == Option.when(time >= first.firstMs)(((time - first.firstMs) / 100).min(first.count - 1))

  property("past actions are dropped, and the number of stored actions is limited"):
    forAll(plans, Gen.choose(0, 5000)): (plans, now) =>
      val buffer = plans.foldLeft(empty)(_.receive(_, now))
      buffer.actions.count(_.at <= ms(now)) <= 1 && buffer.actions.size <= PlanBuffer.Limit

  test("no action is in effect before the first time, and the next time is known"):
    val buffer = empty.receive(Sent(0, 1000, 3))
    assertEquals(buffer.dueAt(999), None)
    assertEquals(buffer.nextAfter(ms(999)), Some(ms(1000)))
    assertEquals(buffer.dueAt(1099), Some((0L, 0)))
    assertEquals(buffer.nextAfter(ms(1199)), Some(ms(1200)))
    assertEquals(buffer.nextAfter(ms(1200)), None)

  test("a plan has at most 16 actions, ascending by their times"):
    def mistake(moments: Int*) =
      intercept[IllegalArgumentException](
        CommandPlan(0, moments.map(time => (at = ms(time), action = Action.Hover)).toVector)
      ).getMessage
    assertEquals(mistake(100, 100), "a command's plan: expected moments in ascending order, got others")
    assertEquals(mistake(0 to 16*), "a command's plan: expected at most 16 actions, got 17")
