package skein.environment

import java.nio.ByteBuffer
import java.util.stream.IntStream
import scala.util.Try
import skein.lanes.{Engine, LearnerWorlds}
import skein.policy.Policy
import skein.scenario.Scenarios
import skein.settings.PolicyFile
import skein.units.{Expect, eachBelow}

/** Many episodes, simulated step by step. The caller decides for learners ([[EnvironmentSettings]]), at the
  * times at which the loop decides, on readings with the age that the link causes. Observations and actions
  * are in [[EnvironmentBuffers]].
  *
  * A step is one decision, or one of each learner that decides at that moment. Its reward is, for a pursuer,
  * minus the distances to its nearest opponent scored since the last step (once a period), divided by 10 m,
  * and 10 for a capture; for an evader the opposite. So the pursuer's rewards of an episode of the duel
  * without a capture sum to minus its mean distance, as `./skein search` has it, times the number of periods,
  * divided by 10 m. Means of other quantities may be rewarded instead, divided by 10 likewise, or a root mean
  * square: then each reward is a square, divided by 100.
  *
  * Environments are simulated with SIMD, up to [[LearnerWorlds.Most]] together, or one by one by the scalar
  * reference; [[engine]] states which, and why.
  *
  * One call at a time. A step with SIMD allocates nothing, except where many groups share the processors.
  *
  * @param count number of environments
  * @param block memory of [[EnvironmentBuffers.bytes]] bytes
  */
final class EnvironmentBatch private (
    side: LearnerSide,
    val count: Int,
    autoreset: Autoreset,
    block: ByteBuffer
) extends AutoCloseable:
  private val buffers = EnvironmentBuffers(block, side.learners, count, side.settings.space)
  private var flownBy = side.engine(None)
  private var groups  = groupsOf(None)
  private var isReset = false

  /** The engine that simulates the environments. */
  def engine: Engine = flownBy

  private def groupsOf(beside: Option[Policy]): Array[EnvironmentGroup] =
    val most = if engine.fliesByLanes then LearnerWorlds.Most else 1
    for
      (learning, turn) <- side.turns.toArray.zipWithIndex
      numbers          <- (turn until count by side.turns.size).grouped(most)
    yield
      val worlds = EnvironmentBatch.worlds(side, engine, learning, beside, numbers.size)
      val stride = side.turns.size
      EnvironmentGroup(side, learning, worlds, autoreset, numbers.head, stride, numbers.size, buffers)

  /** Sets the policy of the other vehicles of a learner's role, if its vehicles learn in turns; then all
    * environments must be reset.
    */
  def fly(policy: Policy): Unit = if side.turns.size > 1 then
    close()
    flownBy = side.engine(Some(policy))
    groups = groupsOf(Some(policy))
    isReset = false

  /** Ends all episodes; no method may be called afterwards. */
  def close(): Unit = groups.foreach(_.close())

  /** Resets every environment.
    *
    * @param seeds one for each environment; a negative one continues the environment's own sequence
    */
  def reset(seeds: Array[Long]): Unit =
    require(seeds.length == count, s"expected $count seeds, got ${seeds.length}")
    groups.foreach(_.reset(seeds))
    isReset = true

  /** Resets each environment that `mask` selects, with its entry in the seeds. */
  def reset(seeds: Array[Long], mask: Array[Boolean]): Unit =
    require(seeds.length == count && mask.length == count, s"expected $count seeds and as long a mask")
    require(isReset, "expected a reset of all environments before one of some")
    groups.foreach(_.reset(seeds, mask))

  /** Advances every environment by one step.
    *
    * @throws IllegalArgumentException if an action is not finite; then nothing was done
    * @throws IllegalStateException if an episode has ended, and was not reset
    */
  def step(): Unit =
    if !isReset then throw IllegalStateException("expected reset() before the first step()")
    eachBelow(groups.length): i =>
      val misfit = groups(i).misfit()
      if misfit >= 0 then
        throw IllegalArgumentException(
          s"action of environment $misfit: expected a number from -1 to 1, got none"
        )
      val ended = groups(i).ended
      if ended >= 0 then
        throw IllegalStateException(s"environment $ended has ended; reset it before the next step()")
    // A step lasts microseconds; the common pool distributes its parts without starting or waking a thread
    // for each.
    if groups.length < EnvironmentBatch.Together then groups.foreach(_.step())
    else IntStream.range(0, groups.length).parallel().forEach(groups(_).step())

object EnvironmentBatch:

  /** The worlds of `count` environments that an engine simulates together. */
  private[environment] def worlds(
      side: LearnerSide,
      by: Engine,
      learning: Vector[Int],
      beside: Option[Policy],
      count: Int
  ): LearnerWorlds =
    val team = side.team(learning, beside)
    if by.fliesByLanes then side.maker.of(team, learning, count).fold(sys.error, identity)
    else LearnerRollout(side, team, learning)

  val Most = 1 << 20

  /** Minimum number of groups for which several threads are used. */
  private val Together = 4

  /** The engine for such environments; Left says what was expected and what was given.
    *
    * @param beside see [[EnvironmentBatch.fly]]
    */
  def engine(
      settings: EnvironmentSettings,
      opponent: Option[PolicyFile] = None,
      beside: Option[Policy] = None
  )(using Scenarios): Either[String, Engine] =
    LearnerSide.of(settings, opponent).map(side => side.engine(beside.filter(_ => side.turns.size > 1)))

  /** @param opponent policy of the vehicles of another role; without one, as the settings name it
    * @return Left says what was expected and what was given
    */
  def of(
      settings: EnvironmentSettings,
      count: Int,
      autoreset: Autoreset,
      block: ByteBuffer,
      opponent: Option[PolicyFile] = None
  )(using Scenarios): Either[String, EnvironmentBatch] =
    LearnerSide.of(settings, opponent).flatMap(Prepared(_).batch(count, autoreset, block))

  private[environment] def prepared(settings: EnvironmentSettings)(using
      Scenarios
  ): Either[String, Prepared] = LearnerSide.of(settings).map(Prepared(_))

  /** Resolves settings, for callers in other languages.
    *
    * @param settings by the names of [[EnvironmentSettings]] in snake case; missing ones have their defaults
    * @throws IllegalArgumentException with what was expected and what was given
    */
  def prepare(settings: java.util.Map[String, String]): Prepared =
    orThrow(EnvironmentSettings.read(settings).flatMap(prepared(_)(using Scenarios.ours)))

  private def orThrow[A](made: Either[String, A]): A =
    made.fold(mistake => throw IllegalArgumentException(mistake), identity)

  /** Resolved settings. A caller needs the number of learners before it can make the memory of a batch. */
  final class Prepared private[EnvironmentBatch] (side: LearnerSide):
    /** Names of an environment's learners, in the order of [[EnvironmentBuffers]]: the first one's, where
      * they take turns.
      */
    private[environment] def names: Vector[String] = side.turns.head.map(side.names)

    private[environment] def batch(
        count: Int,
        autoreset: Autoreset,
        block: ByteBuffer
    ): Either[String, EnvironmentBatch] =
      for
        _    <- Expect.that(count >= 1 && count <= Most)(s"num_envs: expected 1 to $Most, got $count")
        made <- Try(new EnvironmentBatch(side, count, autoreset, block)).toEither.left.map(_.getMessage)
      yield made

    /** The learners' names, one line each, for callers in other languages. */
    def learners: String = names.mkString("\n")

    /** Makes a batch, for callers in other languages.
      *
      * @throws IllegalArgumentException with what was expected and what was given
      */
    def make(count: Int, autoreset: Int, block: ByteBuffer): EnvironmentBatch =
      orThrow(batch(count, Autoreset.fromOrdinal(autoreset), block))
