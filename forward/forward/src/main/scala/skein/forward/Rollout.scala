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

  private val loop     = LoopRuns.of(timing, world)
  private val periodNs = Nanos.of(timing.periodS)
  private val scores   = (engagement.durationS / timing.periodS).round.toInt
  private val judged   = engagement.judged.toArray
  private val against  = judged.map(engagement.against(_).toArray)
  private val last10s  = Rollout.last10sFromS(engagement.durationS, timing.periodS)
  private var tallies  = judged.map(_ => Score())

  /** Simulates one episode.
    *
    * @param worldKey the world's key of [[WorldRandom]], which determines all delays
    * @param sensorSeed of the errors of readings, by default the key
    */
  def fly(
      worldKey: Int,
      captureRadiusM: Double = 0.0,
      observer: LoopObserver = LoopObserver.Nobody,
      sensorSeed: Option[Long] = None
  ): EpisodeOutcome =
    start(worldKey, captureRadiusM, observer, sensorSeed)
    while !isOver do handle(world.next())
    outcome

  private[skein] def start(
      worldKey: Int,
      captureRadiusM: Double,
      observer: LoopObserver = LoopObserver.Nobody,
      sensorSeed: Option[Long] = None
  ): Unit =
    tallies = judged.map(_ => Score(captureRadiusM, last10s))
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

  private def isOver: Boolean = tallies(0).count >= scores || world.isOver

  /** The outcome of a team: the minimum distance of any evader, the mean over the evaders of each mean, and
    * the time of the last capture; distances are to the nearest pursuer, efforts are summed over a side. In a
    * team without sides all vehicles count, with the distance to the nearest other, and the effort is that of
    * the evaders.
    */
  private[skein] def outcome: EpisodeOutcome =
    val each    = evaderOutcomes
    val nearest = each.minBy(_.minDistanceM)
    EpisodeOutcome(
      nearest.minDistanceM,
      nearest.minDistanceAtS,
      each.map(_.meanDistanceM).sum / each.size,
      each.map(_.meanLast10sM).sum / each.size,
      each.map(_.captureS).max,
      engagement.pursuers.map(loop.controllers(_).effortRad).sum,
      judged.map(loop.controllers(_).effortRad).sum,
      loop.controllers.map(_.decisions).sum,
      loop.controllers.map(_.skipped).sum
    )

  /** Control effort of a vehicle in the last episode: the sum of all changes of its commanded heading, rad.
    */
  private[skein] def effortRad(vehicle: Int): Double = loop.controllers(vehicle).effortRad

  /** The outcomes of the last episode, one for each evader in the engagement's order; in a team without
    * sides, one for each vehicle.
    */
  def evaderOutcomes: Vector[EvaderOutcome] = tallies.map(_.outcome).toVector

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
    for index <- judged.indices do
      val evader  = world.vehicles(judged(index))
      var nearest = Double.PositiveInfinity
      for agent <- against(index) do
        val pursuer = world.vehicles(agent)
        nearest = math.min(nearest, StrictMath.hypot(evader.x - pursuer.x, evader.y - pursuer.y))
      tallies(index).add(world.nowS, nearest)
    world.schedule((number + 1) * periodNs, ScoreNow, 0, number + 1)

object Rollout:

  /** Time of the first score in the mean of an episode's last 10 s, s. */
  private[skein] def last10sFromS(durationS: Double, periodS: Double): Double =
    (math.floor((durationS - 10 + 1e-9) / periodS) + 1) * periodS

  private[skein] val Never: Long = Long.MaxValue

/** Accumulates the distances of an episode into its outcome. */
private[skein] final class Score(captureRadiusM: Double = 0.0, last10sFromS: Double = 0.0):
  var count                = 0
  private var least        = Double.PositiveInfinity
  private var leastAt      = 0.0
  private var sum, lastSum = 0.0
  private var lastCount    = 0
  private var captureS     = Double.PositiveInfinity

  def add(timeS: Double, distanceM: Double): Unit =
    count += 1
    sum += distanceM
    if distanceM < least then
      least = distanceM; leastAt = timeS
    if distanceM <= captureRadiusM && captureS.isInfinite then captureS = timeS
    if timeS > last10sFromS - 1e-6 then
      lastSum += distanceM
      lastCount += 1

  def outcome: EvaderOutcome = EvaderOutcome(least, leastAt, sum / count, lastSum / lastCount, captureS)
