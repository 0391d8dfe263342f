package skein.forward

/** Simulates engagements, above all duels, under a loop's real timing: the scalar reference, readable and in
  * double. Events happen in the order of their times, in whole nanoseconds; between them the vehicles move
  * independently. Given the delays of a flight in virtual time ([[RecordedDelays]]) it reproduces that flight
  * exactly; `RolloutParitySimulation` compares the two. Mutable: one per thread.
  *
  * @param link delays of requests, answers, commands and acknowledgements; `Paused` ignores it
  * @param responses by vehicle
  * @param asksPolicies see [[RolloutWorld]]
  */
final class Rollout private[skein] (
    engagement: Engagement,
    timing: LoopTiming,
    link: Delays,
    responses: Vector[VelocityResponse],
    asksPolicies: Boolean
):
  import RolloutWorld.*

  /** @param model of all vehicles but cars, which drive by [[CarResponse]] */
  def this(engagement: Engagement, timing: LoopTiming, link: Delays, model: VelocityResponse) =
    this(engagement, timing, link, TeamResponses.of(engagement.agents, model), asksPolicies = true)

  private val world = RolloutWorld(
    engagement,
    link,
    responses,
    timing.asking,
    keepsAll = timing.isInstanceOf[LoopTiming.Predictive],
    asksPolicies,
    standsStill = timing.isInstanceOf[LoopTiming.Paused],
    ringOf(timing, engagement.agents.size)
  )
  private val trackers = Array.tabulate(engagement.agents.size)(agent =>
    engagement.agents(agent).eye.map: eye =>
      val rivals = engagement.assignment.rivals(agent)
      require(rivals.sizeIs == 1, s"an eye looks for one opponent, vehicle $agent has ${rivals.size}")
      CameraTracker(world, agent, rivals.head, eye, link)
  )
  for agent <- trackers.indices do world.views(agent) = trackers(agent)

  private val loop = timing match
    case paused: LoopTiming.Paused         => PausedRun(paused, world)
    case sequential: LoopTiming.Sequential => SequentialRun(sequential, world)
    case futures: LoopTiming.Futures       => FuturesRun(futures, world)
    case stream: LoopTiming.Stream         => StreamRun(stream, world)
    case predictive: LoopTiming.Predictive => PredictiveRun(predictive, world)
  private val periodNs = Nanos.of(timing.periodS)
  private val scores   = (engagement.durationS / timing.periodS).round.toInt
  private var scored   = 0

  /** Simulates one episode.
    *
    * @param worldKey the world's key of [[WorldRandom]], which determines all delays
    * @param sensorSeed of the errors of readings, by default the key
    */
  def fly(
      worldKey: Int,
      observer: LoopObserver = LoopObserver.Nobody,
      sensorSeed: Option[Long] = None
  ): Unit =
    start(worldKey, observer, sensorSeed)
    while !isOver do handle(world.next())

  private[skein] def start(
      worldKey: Int,
      observer: LoopObserver = LoopObserver.Nobody,
      sensorSeed: Option[Long] = None
  ): Unit =
    scored = 0
    world.start(worldKey, observer, sensorSeed = sensorSeed)
    for tracker <- trackers; eye <- tracker do eye.start(worldKey)
    world.schedule(periodNs, ScoreNow, 0, 1)
    for controller <- loop.controllers do controller.start()
    loop.start()

  /** Handles the events before this time.
    *
    * @return the time of the next event; [[Rollout.Never]] if the episode is over
    */
  private[skein] def flyUntil(timeNs: Long): Long =
    while !isOver && world.nextNs < timeNs do handle(world.next())
    if isOver then Rollout.Never else world.nextNs

  /** Whether the episode ended before its duration, because the engagement was over. */
  private[skein] def hasEnded: Boolean = world.isOver

  private def isOver: Boolean = scored >= scores || world.isOver

  /** The vehicles' controllers, as the last episode left them. */
  private[skein] def controllers: Array[Controller] = loop.controllers

  private def handle(event: Long): Unit =
    val vehicle = vehicleOf(event)
    val number  = numberOf(event)
    kindOf(event) match
      case ScoreNow                                              => scoreNow(number)
      case Tick | Sampled | Answered | TimedOut | Patience | Due => loop.handle(event)
      case Arrived                                               => world.arrived(vehicle, number)
      case Acts                                                  => world.acts(vehicle, number)
      case Acknowledged                                          =>
        loop.replaced(vehicle, number)
        loop.controllers(vehicle).acknowledged()
      case Wake => loop.controllers(vehicle).goOn()
      case kind => trackers(vehicle).foreach(_.handle(kind, number))

  private def scoreNow(number: Int): Unit =
    for vehicle <- world.vehicles do vehicle.advance(world.nowS)
    for index <- world.vehicles.indices do
      val vehicle = world.vehicles(index)
      world.observer.scored(world.nowS, index, vehicle.x, vehicle.y, vehicle.z)
    scored += 1
    world.schedule((number + 1) * periodNs, ScoreNow, 0, number + 1)

object Rollout:

  /** Time of the first score in the mean of an episode's last 10 s, s. */
  private[skein] def last10sFromS(durationS: Double, periodS: Double): Double =
    (math.floor((durationS - 10 + 1e-9) / periodS) + 1) * periodS

  private[skein] val Never: Long = Long.MaxValue
