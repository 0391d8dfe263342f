package skein.forward

import skein.forecast.Forecast
import skein.policy.{
  Observation,
  ObservingPolicy,
  PlanarObservation,
  HeadingPolicy,
  Seen
}
import skein.signal.Kinematics
import skein.units.{Instant, Metres, MetresPerSecond, OwnFailure, Radians, Span}

/** What a decision is made from: a reading of each vehicle, and the headings sent to them until then.
  * Mutable.
  *
  * @see `skein.loop.TeamView`, which the live loops hold
  */
private[skein] final class RolloutView(world: RolloutWorld) extends Grounds:
  private val count               = world.count
  private val keepsAll            = world.keepsKinematics
  val x, y, vx, vy: Array[Double] = Array.ofDim[Double](count)

  /** Headings sent last, rad. */
  val sent: Array[Double] = Array.ofDim[Double](count)

  val sentDecision: Array[Int] = Array.ofDim[Int](count)

  val reading: Array[Int] = Array.ofDim[Int](count)

  /** The step of the loop that each vehicle's reading belongs to; what a delay is drawn by. */
  val step: Array[Int] = Array.ofDim[Int](count)

  val validAtNs: Array[Long] = Array.ofDim[Long](count)

  /** All that the readings tell, in worlds that keep it. */
  val kinematics: Array[Kinematics] = Array.ofDim[Kinematics](if keepsAll then count else 0)

  /** What the readings are to be replaced by when it is decided. */
  var forecast: Option[Forecast] = None

  def copyFrom(other: RolloutView): Unit =
    for vehicle <- 0 until count do
      x(vehicle) = other.x(vehicle); y(vehicle) = other.y(vehicle)
      vx(vehicle) = other.vx(vehicle); vy(vehicle) = other.vy(vehicle)
      sent(vehicle) = other.sent(vehicle); sentDecision(vehicle) = other.sentDecision(vehicle)
      step(vehicle) = other.step(vehicle); reading(vehicle) = other.reading(vehicle)
      validAtNs(vehicle) = other.validAtNs(vehicle)
      if keepsAll then kinematics(vehicle) = other.kinematics(vehicle)
    forecast = other.forecast

  def take(vehicle: Int, question: Int): Unit =
    val slot = world.slot(vehicle, question)
    x(vehicle) = world.x(slot); y(vehicle) = world.y(slot)
    vx(vehicle) = world.vx(slot); vy(vehicle) = world.vy(slot)
    if keepsAll then kinematics(vehicle) = world.seen(vehicle, question)
    step(vehicle) = world.stepOf(vehicle, question)
    reading(vehicle) = question
    validAtNs(vehicle) = world.validAtNs(slot)

  /** Takes the headings sent to all vehicles until now. */
  def takeSent(controllers: Array[Controller]): Unit =
    for vehicle <- 0 until count do
      sent(vehicle) = controllers(vehicle).sentHeading
      sentDecision(vehicle) = controllers(vehicle).sentDecision

/** Decides for one vehicle and commands it, as `skein.flow.Pace` and `skein.flow.Steer` let it: the newest
  * observation, at least an interval after the last, whenever a command may be sent.
  *
  * @param intervalNs between two decisions, or between two commands if it `decidesFirst`
  * @param decidesFirst decides at every observation; then what waits is the decision
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

  private val policy     = world.agents(agent).policy
  private val minNs      = Nanos.of(steering.minIntervalS)
  private val handoverNs = Nanos.of(steering.handoverS)
  private val held       = RolloutView(world)

  private var outstanding   = 0
  private var mayCommandAt  = 0L
  private var mayCommand    = false
  private var turnAt        = 0L
  private var holds         = false
  private var lastDecidedAt = Controller.Never
  private var decided       = 0.0
  private var speed         = 0.0
  private var sent          = 0.0
  private var sentNumber    = 0
  private var made, unused  = 0

  /** By which a policy decides that is no [[HeadingPolicy]]. */
  private val choosing                = Choosing(world.agents(agent), world.regardsYaw)
  private var chosenNorth, chosenEast = 0.0
  private var isChosen                = false

  /** What the policy remembers. */
  private var memory: Any = ()

  /** What is decided upon, and how far away it shows another vehicle. */
  private var upon                    = held
  private val distance: Int => Double =
    other => StrictMath.hypot(upon.x(agent) - upon.x(other), upon.y(agent) - upon.y(other))
  private var turned = 0.0

  /** Rad. */
  def sentHeading: Double = sent

  /** Which decision that was, from 1; 0 before any was sent. */
  def sentDecision: Int = sentNumber

  def decisions: Int = made

  /** The sum of all changes of the decided heading. */
  def effortRad: Double = turned

  /** Sights or decisions that a newer one replaced. */
  def skipped: Int = unused

  def start(): Unit =
    outstanding = 0; mayCommandAt = 0; mayCommand = false; turnAt = 0; holds = false
    lastDecidedAt = Controller.Never
    decided = world.agents(agent).startHeadingRad
    memory = ObservingPolicy.initialOf(policy)
    isChosen = false
    if world.isAsked(agent) then choosing.start()
    speed = world.agents(agent).speed
    sent = decided; sentNumber = 0
    made = 0; unused = 0; turned = 0
    goOn()

  def offer(observation: RolloutView): Unit =
    if holds then unused += 1
    holds = true
    held.copyFrom(observation)
    if decidesFirst then decide(held)
    goOn()

  /** A command was answered. */
  def acknowledged(): Unit =
    outstanding -= 1
    if outstanding > 0 then mayCommandAt = math.max(mayCommandAt, world.nowNs + handoverNs)
    goOn()

  /** Does what it is time for. */
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

  /** What the policy decided last, rad. */
  def decidedHeading: Double = decided

  /** And how fast it is to fly, m/s. */
  def decidedSpeed: Double = speed

  /** And with which velocity, m/s. */
  def decidedNorth: Double = if isChosen then chosenNorth else speed * StrictMath.cos(decided)
  def decidedEast: Double  = if isChosen then chosenEast else speed * StrictMath.sin(decided)

  def decide(observation: RolloutView): Unit =
    val now       = world.nowNs
    val elapsedNs = if lastDecidedAt == Controller.Never then 0L else now - lastDecidedAt
    val elapsed   = elapsedNs * 1e-9
    val before    = decided
    for forecast <- observation.forecast do ahead(observation, forecast)
    policy match
      case duel: HeadingPolicy => decided = heading(duel, observation, elapsed)
      case _                   =>
        val chosen = choosing.choose(observed(observation, elapsedNs))
        decided = chosen.headingRad
        speed = chosen.speedMps
        chosenNorth = chosen.northMps
        chosenEast = chosen.eastMps
        isChosen = true
    turned += math.abs(math.IEEEremainder(decided - before, 2 * math.Pi))
    lastDecidedAt = now
    made += 1
    world.decided(agent, elapsed, observation)

  /** What any policy decides upon, as `skein.loop.Decider` has it. */
  private def observed(observation: RolloutView, elapsedNs: Long): Observation =
    upon = observation
    val now = world.nowNs
    val own = world.agents(agent)
    Observation(
      agent,
      Vector.tabulate(world.count): vehicle =>
        val age = Span.ofNanos(now - observation.validAtNs(vehicle))
        Seen(observation.kinematics(vehicle), age, isPredicted = observation.forecast.isDefined)
      ,
      world.assignment.opponentOf(agent, distance),
      Vector.tabulate(world.count)(each =>
        Radians(if each == agent then decided else observation.sent(each))
      ),
      Span.ofNanos(elapsedNs),
      made,
      MetresPerSecond(own.speed),
      Metres(own.altitudeDownM),
      actsIn = observation.forecast.fold(Span.Zero)(actsIn)
    )

  private def heading(policy: HeadingPolicy, observation: RolloutView, elapsedS: Double): Double =
    upon = observation
    val other = world.assignment.opponentOf(agent, distance)
    world.views(agent) match
      case None =>
        chosen(
          policy,
          observation,
          elapsedS,
          observation.x(other),
          observation.y(other),
          observation.vx(other),
          observation.vy(other),
          observation.sent(other),
          ageS(observation, other)
        )
      case Some(view) =>
        val (place, velocity, sinceS) = view.believed(observation.forecast.map(actsInS))
        view.turn(place.x - observation.x(agent), place.y - observation.y(agent))
        chosen(
          policy,
          observation,
          elapsedS,
          place.x,
          place.y,
          velocity.x,
          velocity.y,
          StrictMath.atan2(velocity.y, velocity.x),
          sinceS
        )

  /** From now until a command acts that is sent now. */
  private def actsInS(forecast: Forecast): Double = actsIn(forecast).toSeconds

  private def actsIn(forecast: Forecast): Span =
    val now = Instant.ofNanos(world.nowNs)
    forecast.whenActing(now).get(agent).predictedFor.since(now).max(Span.Zero)

  private def ageS(observation: RolloutView, vehicle: Int) =
    (world.nowNs - observation.validAtNs(vehicle)) * 1e-9

  /** What a policy chooses whose opponent is there, flies so, was told this heading, and was known so long
    * ago.
    */
  private def chosen(
      policy: HeadingPolicy,
      observation: RolloutView,
      elapsedS: Double,
      x: Double,
      y: Double,
      vx: Double,
      vy: Double,
      sentRad: Double,
      otherAgeS: Double
  ): Double =
    val (dx, dy)   = (x - observation.x(agent), y - observation.y(agent))
    val (dvx, dvy) = (vx - observation.vx(agent), vy - observation.vy(agent))
    policy match
      case observing: ObservingPolicy[?] =>
        val seen =
          PlanarObservation(dx, dy, dvx, dvy, decided, sentRad, elapsedS, ageS(observation, agent), otherAgeS)
        val answer = asked(ObservingPolicy.decide(observing, seen, memory))
        memory = answer.memory
        answer.headingRad
      case _ => asked(policy.heading(dx, dy, dvx, dvy, decided, sentRad, elapsedS))

  /** @throws OwnFailure if the policy throws
    */
  private def asked[A](answer: => A): A =
    OwnFailure.told(OwnFailure.named("policy", policy))(answer)

  /** Puts where the vehicles will be in the place of where they were read. */
  private def ahead(observation: RolloutView, forecast: Forecast): Unit =
    val estimates = forecast.whenActing(Instant.ofNanos(world.nowNs)).get
    for vehicle <- 0 until world.count do
      val kinematics = estimates(vehicle).kinematics
      observation.kinematics(vehicle) = kinematics
      observation.x(vehicle) = kinematics.positionNed.x; observation.y(vehicle) = kinematics.positionNed.y
      observation.vx(vehicle) = kinematics.velocityNed.x; observation.vy(vehicle) = kinematics.velocityNed.y

  /** Notes that a decision was sent without any message. */
  def sentNow(): Unit =
    sent = decided
    sentNumber = made

  private def send(step: Int): Unit =
    mayCommand = false
    mayCommandAt = world.nowNs + minNs
    outstanding += 1
    sentNow()
    val (north, east) = (decidedNorth, decidedEast)
    onSent.sent(agent, world.send(agent, decided, speed, north, east, step), north, east)
    goOn()

private[skein] object Controller:
  /** Is told of every command sent. */
  trait OnSent:
    def sent(agent: Int, number: Int, northMps: Double, eastMps: Double): Unit

  private val Never = Long.MinValue
