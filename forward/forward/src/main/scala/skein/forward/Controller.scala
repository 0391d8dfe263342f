package skein.forward

import skein.forecast.Forecast
import skein.policy.{Action, Observation, Seen}
import skein.signal.Kinematics
import skein.units.{Instant, Metres, MetresPerSecond, Radians, Span}

/** The data for a decision: a reading of each vehicle, and the last headings sent to them. Mutable.
  *
  * @see `skein.loop.TeamView`, which the live loops hold
  */
private[skein] final class RolloutView(world: RolloutWorld) extends Grounds:
  private val count       = world.count
  private val keepsAll    = world.keepsKinematics
  val x, y: Array[Double] = Array.ofDim[Double](count)

  /** Last heading sent to each vehicle, rad. */
  val sent: Array[Double] = Array.ofDim[Double](count)

  val sentDecision: Array[Int] = Array.ofDim[Int](count)

  val reading: Array[Int] = Array.ofDim[Int](count)

  /** The step of the loop to which each vehicle's reading belongs; the index of its random delays. */
  val step: Array[Int] = Array.ofDim[Int](count)

  val validAtNs: Array[Long] = Array.ofDim[Long](count)

  /** The full readings, in worlds that keep them. */
  val kinematics: Array[Kinematics] = Array.ofDim[Kinematics](if keepsAll then count else 0)

  /** The forecast whose predictions replace the readings at the decision. */
  var forecast: Option[Forecast] = None

  def copyFrom(other: RolloutView): Unit =
    for vehicle <- 0 until count do
      x(vehicle) = other.x(vehicle); y(vehicle) = other.y(vehicle)
      sent(vehicle) = other.sent(vehicle); sentDecision(vehicle) = other.sentDecision(vehicle)
      step(vehicle) = other.step(vehicle); reading(vehicle) = other.reading(vehicle)
      validAtNs(vehicle) = other.validAtNs(vehicle)
      if keepsAll then kinematics(vehicle) = other.kinematics(vehicle)
    forecast = other.forecast

  def take(vehicle: Int, question: Int): Unit =
    val slot = world.slot(vehicle, question)
    x(vehicle) = world.x(slot); y(vehicle) = world.y(slot)
    if keepsAll then kinematics(vehicle) = world.seen(vehicle, question)
    step(vehicle) = world.stepOf(vehicle, question)
    reading(vehicle) = question
    validAtNs(vehicle) = world.validAtNs(slot)

  /** Copies the last headings sent to all vehicles. */
  def takeSent(controllers: Array[Controller]): Unit =
    for vehicle <- 0 until count do
      sent(vehicle) = controllers(vehicle).sentHeading
      sentDecision(vehicle) = controllers(vehicle).sentDecision

/** Decides for one vehicle and commands it, with the timing of `skein.flow.Pace` and `skein.flow.Steer`: the
  * newest observation, at least an interval after the last, whenever a command may be sent.
  *
  * @param intervalNs minimum time between two decisions, or between two commands if it `decidesFirst`
  * @param decidesFirst whether it decides at every observation; then decisions wait, and not observations
  */
private[skein] final class Controller(
    world: RolloutWorld,
    agent: Int,
    steering: Steering,
    intervalNs: Long,
    decidesFirst: Boolean,
    onSent: Controller.OnSent
):
  import RolloutWorld.*

  private val own        = world.agents(agent)
  private val minNs      = Nanos.of(steering.minIntervalS)
  private val handoverNs = Nanos.of(steering.handoverS)
  private val held       = RolloutView(world)

  private var outstanding   = 0
  private var mayCommandAt  = 0L
  private var mayCommand    = false
  private var turnAt        = 0L
  private var holds         = false
  private var lastDecidedAt = Controller.Never

  /** When this vehicle's reading of the first decision was sampled. */
  private var firstReadAt  = Controller.Never
  private var decided      = 0.0
  private var sent         = 0.0
  private var sentNumber   = 0
  private var made, unused = 0

  private val choosing       = Choosing(own, world.responses(agent))
  private val startDown      = Metres(own.altitudeDownM)
  private var action: Action = straight

  /** Flight along the last decided heading. */
  private def straight: Action = Action.Along(Radians(decided), MetresPerSecond(own.speed), startDown)

  /** The view of the present decision, and its distance to another vehicle. */
  private var upon                    = held
  private val distance: Int => Double =
    other => StrictMath.hypot(upon.x(agent) - upon.x(other), upon.y(agent) - upon.y(other))
  private var turned = 0.0

  def sentHeading: Double = sent

  /** Number of the last sent decision, from 1; 0 before any was sent. */
  def sentDecision: Int = sentNumber

  def decisions: Int = made

  /** Control effort: sum of all changes of the decided heading, rad. */
  def effortRad: Double = turned

  /** Number of views or decisions that a newer one replaced. */
  def skipped: Int = unused

  def start(): Unit =
    outstanding = 0; mayCommandAt = 0; mayCommand = false; turnAt = 0; holds = false
    lastDecidedAt = Controller.Never
    firstReadAt = Controller.Never
    decided = own.startHeadingRad
    if world.asksPolicies then choosing.start() else action = straight
    sent = decided; sentNumber = 0
    made = 0; unused = 0; turned = 0
    goOn()

  def offer(observation: RolloutView): Unit =
    if holds then unused += 1
    holds = true
    held.copyFrom(observation)
    if decidesFirst then decide(held)
    goOn()

  /** Called when a command was answered. */
  def acknowledged(): Unit =
    outstanding -= 1
    if outstanding > 0 then mayCommandAt = math.max(mayCommandAt, world.nowNs + handoverNs)
    goOn()

  /** Decides or sends whatever is due now. */
  def goOn(): Unit =
    if !mayCommand && outstanding < steering.mostOutstanding then
      if world.nowNs >= mayCommandAt then mayCommand = true
      else world.schedule(mayCommandAt, Wake, agent, 0)
    if mayCommand && holds then
      if world.nowNs >= turnAt then
        turnAt = world.nowNs + intervalNs
        holds = false
        if !decidesFirst then decide(held)
        send(held.step(agent))
      else world.schedule(turnAt, Wake, agent, 0)

  def decidedAction: Action = action

  def decide(observation: RolloutView): Unit =
    val now       = world.nowNs
    val elapsedNs = if lastDecidedAt == Controller.Never then 0L else now - lastDecidedAt
    val elapsed   = elapsedNs * 1e-9
    val before    = decided
    for forecast <- observation.forecast do ahead(observation, forecast)
    upon = observation
    if firstReadAt == Controller.Never then firstReadAt = observation.validAtNs(agent)
    val believed = world.views(agent).map: view =>
      val known = view.believed(observation.forecast.map(actsIn(_).toSeconds))
      view.turn(known.placeNed.x - observation.x(agent), known.placeNed.y - observation.y(agent))
      known
    if world.asksPolicies then
      action = choosing.choose(observed(observation, believed, elapsedNs))
      decided = action.headingRad(decided)
    turned += math.abs(math.IEEEremainder(decided - before, 2 * math.Pi))
    lastDecidedAt = now
    made += 1
    world.decided(agent, elapsed, observation)

  /** The observation for a policy, as `skein.loop.Decider` builds it.
    *
    * @param believed the estimate of the opponent by a camera, in place of its reading
    */
  private def observed(
      observation: RolloutView,
      believed: Option[OpponentView.Believed],
      elapsedNs: Long
  ): Observation =
    val now         = world.nowNs
    val opponent    = world.assignment.opponentOf(agent, distance)
    val isPredicted = observation.forecast.isDefined
    val ahead       = observation.forecast.fold(Span.Zero)(actsIn)
    val seen        = Observation(
      agent,
      Vector.tabulate(world.count): vehicle =>
        val age = Span.ofNanos(now - observation.validAtNs(vehicle))
        Seen(observation.kinematics(vehicle), age, isPredicted)
      ,
      opponent,
      Vector.tabulate(world.count)(each =>
        Radians(if each == agent then decided else observation.sent(each))
      ),
      Span.ofNanos(elapsedNs),
      made,
      MetresPerSecond(own.speed),
      startDown,
      actsIn = ahead,
      time = Span.ofNanos(now - firstReadAt) + ahead
    )
    believed.fold(seen): known =>
      import known.velocityNed
      val motion = seen.vehicles(opponent).kinematics.copy(known.placeNed, velocityNed)
      seen.copy(
        vehicles = seen.vehicles.updated(opponent, Seen(motion, known.age, isPredicted)),
        headings =
          seen.headings.updated(opponent, Radians(StrictMath.atan2(velocityNed.y, velocityNed.x)))
      )

  /** Time from now until a command sent now takes effect. */
  private def actsIn(forecast: Forecast): Span =
    val now = Instant.ofNanos(world.nowNs)
    forecast.whenActing(now).get(agent).predictedFor.since(now).max(Span.Zero)

  /** Replaces the readings by predictions. */
  private def ahead(observation: RolloutView, forecast: Forecast): Unit =
    val estimates = forecast.whenActing(Instant.ofNanos(world.nowNs)).get
    for vehicle <- 0 until world.count do
      val kinematics = estimates(vehicle).kinematics
      observation.kinematics(vehicle) = kinematics
      observation.x(vehicle) = kinematics.positionNed.x; observation.y(vehicle) = kinematics.positionNed.y

  /** Records a decision as sent, although no message was sent. */
  def sentNow(): Unit =
    sent = decided
    sentNumber = made

  private def send(step: Int): Unit =
    mayCommand = false
    mayCommandAt = world.nowNs + minNs
    outstanding += 1
    sentNow()
    onSent.sent(agent, world.send(agent, action, step), action)
    goOn()

private[skein] object Controller:
  /** Receives every command that a controller sends. */
  trait OnSent:
    def sent(agent: Int, number: Int, action: Action): Unit

  private val Never = Long.MinValue
