package skein.loop

import skein.forecast.{Commanded, Forecast, ForecastEvent}
import skein.policy.{Action, ActionGuidance, Fleet, Flee}
import skein.port.CommandPlan
import skein.scenario.PaperDuel
import skein.signal.{Kinematics, Stamped}
import skein.units.*
import skein.vehicle.{ConstantVelocity, QuadrotorModel}

class ForeseenSuite extends munit.FunSuite:
  private val fleet    = PaperDuel().fleet
  private val deciders = fleet.agents.indices.map(Decider(fleet, _))
  private val period   = Span.ofMillis(100)
  private val foreseen = Foreseen(fleet, deciders, period)
  private val starts   = deciders.map(_.start).toVector

  private def millis(n: Double) = Instant.Epoch + Span.ofMillis(n)

  /** Both vehicles at rest at their starts, read at 20 ms over 20 ms each way. */
  private val seen: TeamView =
    val empty =
      TeamView.empty(2).copy(forecast = Some(Forecast(fleet.agents.map(_ => QuadrotorModel.AirSim))))
    fleet.agents.zipWithIndex.foldLeft(empty): (view, placed) =>
      val (agent, vehicle) = placed
      val state = Kinematics(agent.startPositionNed, Vector3.Zero, Quaternion.Identity, Vector3.Zero)
      view.withReading(Reading(vehicle, 0, Stamped(state, millis(20), millis(0), millis(40))))

  /** The view of a loop that has sent its commands and decides again at `now`, without newer readings. */
  private def predicted(view: TeamView, now: Instant) =
    view.copy(estimates = view.forecast.flatMap(_.whenActing(now)))

  private val now  = millis(50)
  private val view = predicted(seen, now)

  test("a plan's full number of actions is foreseen, a period apart, from the time at which a command acts"):
    val all = foreseen.actions(0, view, starts.map(Foreseen.Mind(_, None)), now)
    assertEquals(all.map(_.size), Vector.fill(2)(CommandPlan.Most))
    val moments = Vector.tabulate(CommandPlan.Most)(number => millis(70) + period * number.toLong)
    assertEquals(all.map(_.map(_.at)), Vector.fill(2)(moments))

  test("foreseen actions equal the later decisions, period by period, if nothing else is read"):
    val all  = foreseen.actions(0, view, starts.map(Foreseen.Mind(_, None)), now)
    val sent = all.zipWithIndex.foldLeft(seen): (view, planned) =>
      val commands = planned._1.map((at, action) =>
        Commanded(0, ActionGuidance.of(action), now, actsAt = Some(at))
      )
      view.withEvent(ForecastEvent.Planned(planned._2, commands))
    val decided = (0 until CommandPlan.Most).scanLeft((starts, Vector.empty[Action])): (before, number) =>
      val then_ = predicted(sent, now + period * number.toLong)
      val made  = deciders.zip(before._1).map((decider, memory) =>
        decider.decide(memory, then_, now + period * number.toLong)
      )
      (made.map(_._1).toVector, made.map((_, decision) => decision.performed).toVector)
    for ((_, actions), number) <- decided.tail.zipWithIndex; vehicle <- 0 to 1 do
      (actions(vehicle), all(vehicle)(number).action) match
        case (Action.VelocityAt(n, e, d, _), Action.VelocityAt(north, east, down, _)) =>
          assertEqualsDouble(n, north, 1e-3, s"$number of $vehicle")
          assertEqualsDouble(e, east, 1e-3, s"$number of $vehicle")
          assertEquals(d, down)
        case other => fail(other.toString)

  test("a decision made on the view is its vehicle's first action, and is not made again"):
    val (memory, decision) = deciders(0).decide(starts(0), view, now)
    val minds              = Vector(Foreseen.Mind(memory, Some(decision)), Foreseen.Mind(starts(1), None))
    assertEquals(
      foreseen.actions(0, view, minds, now),
      foreseen.actions(0, view, starts.map(Foreseen.Mind(_, None)), now)
    )

  test("if the other vehicles' policies are unknown, a plan does not depend on them"):
    val stranger = Fleet(fleet.agents.updated(0, fleet.agents(0).copy(policy = Flee(3))))
    val blind    = predicted(
      seen
        .copy(
          knows = Knowledge.Positions,
          strangers = seen.forecast.map(known =>
            val straight = Forecast(fleet.agents.map(_ => ConstantVelocity))
            known.tracks.zipWithIndex.foldLeft(straight):
              case (forecast, (track, vehicle)) =>
                forecast.withEvent(ForecastEvent.Seen(vehicle, track.get.newest))
          )
        )
        .of(1),
      now
    )
    def plans(fleet: Fleet, view: TeamView) =
      val deciders = fleet.agents.indices.map(Decider(fleet, _))
      Foreseen(fleet, deciders, period).actions(
        1,
        view,
        deciders.map(decider =>
          Foreseen.Mind(decider.start, None)
        ).toVector,
        now
      )
    val known = predicted(seen, now)
    assertEquals(plans(fleet, blind), plans(stranger, blind))
    assertNotEquals(plans(fleet, known), plans(stranger, known))
    assertEquals(plans(fleet, blind).map(_.size), Vector(0, CommandPlan.Most))

  test("a vehicle's plan begins with its decision; without predictions there is no plan"):
    val foresight          = Foresight(foreseen, starts)
    val (memory, decision) = deciders(0).decide(starts(0), view, now)
    foresight.decided(0, memory, decision)
    val plan = foresight.planned(decision).plan.getOrElse(fail("no plan"))
    assertEquals(plan.sequence, decision.sequence)
    assertEquals(plan.actions.size, CommandPlan.Most)
    assertEquals(plan.actions.head, (at = millis(70), action = decision.performed))
    val (_, blind) = deciders(0).decide(starts(0), seen, now)
    assertEquals(foresight.planned(blind).plan, None)
