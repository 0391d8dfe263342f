package skein.loop

import skein.policy.{Action, Fleet, Observation, Policy, Seen, Sensed}
import skein.units.*

/** State of one vehicle's decisions, in addition to the view.
  *
  * @param firstReadAt when the vehicle's reading of the first decision was sampled, on the simulator's clock
  * @param held the policy's memory, of a type of its own
  */
final case class Memory(
    headingRad: Double,
    decidedAt: Option[Instant],
    decisions: Long,
    firstReadAt: Option[Instant] = None,
    held: Any = ()
)

/** Decisions for one vehicle of a scenario: the pure core of every loop.
  *
  * @param policy the agent's own policy, or a replacement
  */
final class Decider(fleet: Fleet, self: Int, policy: Policy):
  private val agent = fleet.agents(self)

  def this(fleet: Fleet, self: Int) = this(fleet, self, fleet.agents(self).policy)

  val start: Memory = Memory(agent.startHeading.value, None, 0, None, PolicyAnswer.first(agent)(policy.start))

  /** Decides from a complete view.
    *
    * @throws skein.units.OwnFailure if the policy throws, or its answer cannot be commanded
    * @param now the current time, on the clock of the readings' `receivedAt` and of the moves' `sentAt`
    */
  def decide(memory: Memory, view: TeamView, now: Instant): (Memory, Decision) =
    val seen             = observation(memory, view, now)
    val (action, held)   = answered(memory, seen)
    val (next, decision) = against(seen.opponent, memory, view, now, action)
    (next.copy(held = held), decision)

  /** The policy's action and next memory.
    *
    * @throws skein.units.OwnFailure as [[decide]]
    */
  def answered(memory: Memory, view: TeamView, now: Instant): (Action, Any) =
    answered(memory, observation(memory, view, now))

  private def answered(memory: Memory, seen: Observation): (Action, Any) =
    // A memory comes from this policy alone: from its start, or from its last decision.
    val (action, held) = PolicyAnswer.of(agent):
      policy.choose(seen, memory.held.asInstanceOf[policy.Memory])
    PolicyAnswer.expectAction(agent, action)
    (action, held)

  /** Decides once instead of the policy that owns the memory, and leaves that policy's own part unchanged. */
  def decideInstead(memory: Memory, view: TeamView, now: Instant): (Memory, Decision) =
    val (next, decision) = decide(memory.copy(held = PolicyAnswer.first(agent)(policy.start)), view, now)
    (next.copy(held = memory.held), decision)

  def regardsTeam: Boolean = !policy.isAgainstOne

  /** The observation for the vehicle's policy. */
  def observation(memory: Memory, view: TeamView, now: Instant): Observation =
    val places = fleet.agents.indices.toVector
    val own    = view.readings(self).get.state
    val ahead  = actsIn(view, now)
    Observation(
      self,
      places.map(seen(view, now, _)),
      opponentIn(view),
      places.map(place =>
        Radians(if place == self then memory.headingRad else view.seenHeadingRad(place, fleet))
      ),
      elapsed(memory, now),
      memory.decisions,
      agent.speed,
      Metres(agent.startPositionNed.z),
      view.sensed(self).map: (sensor, reading) =>
        sensor -> Sensed(reading.columns, reading.values.value, view.ageOf(reading.values, now)),
      ahead,
      own.validAt.since(memory.firstReadAt.getOrElse(own.validAt)) + view.ageOf(own, now) + ahead
    )

  private def actsIn(view: TeamView, now: Instant): Span =
    val acting =
      for
        clocks    <- view.alignment
        estimates <- view.estimates
      yield clocks.toController(estimates(self).predictedFor).since(now).max(Span.Zero)
    acting.getOrElse(Span.Zero)

  private def seen(view: TeamView, now: Instant, vehicle: Int): Seen =
    val reading = view.readings(vehicle).get.state
    Seen(view.kinematics(vehicle), view.ageOf(reading, now), isPredicted = view.estimates.isDefined)

  private def elapsed(memory: Memory, now: Instant): Span = memory.decidedAt.fold(Span.Zero)(now.since)

  private def opponentIn(view: TeamView): Int =
    fleet.opponentOf(self, view.kinematics(_).positionNed)

  /** The decision for an action that was chosen elsewhere.
    *
    * @throws skein.units.OwnFailure if a number in it is not finite: no vehicle may receive it
    */
  def decided(memory: Memory, view: TeamView, now: Instant, action: Action): (Memory, Decision) =
    PolicyAnswer.expectAction(agent, action)
    against(opponentIn(view), memory, view, now, action)

  private def against(
      opponent: Int,
      memory: Memory,
      view: TeamView,
      now: Instant,
      action: Action
  ): (Memory, Decision) =
    val decision = Decision(
      vehicle = self,
      sequence = memory.decisions,
      decidedAt = now,
      view = view,
      opponent = opponent,
      headingBefore = Radians(memory.headingRad),
      elapsed = elapsed(memory, now),
      action = action
    )
    val next = memory.copy(
      headingRad = decision.heading.value,
      decidedAt = Some(now),
      decisions = memory.decisions + 1,
      firstReadAt = memory.firstReadAt.orElse(view.readings(self).map(_.state.validAt))
    )
    (next, decision)
