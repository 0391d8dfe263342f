package skein.lanes.gpu

import scala.collection.mutable
import skein.gpu.Gpu
import skein.lanes.{Accelerated, AcceleratedTeams, Episodes, PreparedTeam, TeamForm, TeamOutcomes, TeamWorlds}
import skein.lanes.policy.{OpponentLanes, TeamLanes}

/** Simulates teams' candidates on a GPU, each in all episodes, with [[GpuOpponentKernel]] or
  * [[GpuTeamKernel]]; in parts of some candidates and episodes, so that a call can be cancelled and fits in
  * memory. Mutable; one call at a time.
  *
  * @param threads number of threads that make timetables and read policies
  */
private[lanes] final class GpuTeams(
    gpu: Gpu,
    vehicle: GpuVehicle.Kind,
    prediction: Option[GpuPrediction.Kind],
    threads: Int,
    periodS: Double,
    episodes: Episodes
) extends AcceleratedTeams:
  import GpuTeams.*

  private val onGpu   = mutable.HashMap.empty[(Int, Boolean), GpuEpisodes]
  private val kernels = mutable.HashMap.empty[(TeamForm, GpuLayout), GpuFlightKernel]

  def fly(
      worlds: TeamWorlds,
      prepared: Int => PreparedTeam,
      into: TeamOutcomes,
      onProgress: Int => Unit,
      isCancelled: () => Boolean
  ): Accelerated =
    val each  = worlds.episodesOfEach
    val teams = Array.tabulate(GpuEpisodes.candidatesOf(worlds))(number => prepared(number * each))
    GpuEpisodes.inParallel(teams.length, Chunk, threads)(i =>
      if teams(i).form != null then teams(i).numbers: Unit
    ): Unit
    val (known, unknown) =
      teams.indices.toArray.partition(number => isOnGpu(teams(number)))
    var flown = 0
    for
      (form, alike) <- known.groupBy(teams(_).form)
      decisions = form.count * form.durationS / periodS
      numbers <-
        Array.range(0, each).grouped((MostBytes / 4 / (BytesOfDecision * decisions)).toInt.max(1).min(each))
      some <- alike.grouped((MostDecisions / (numbers.length * decisions)).toInt.max(1))
      if !isCancelled()
      held  = episodesFor(form)
      names = numbers.toVector.map(i => episodes.nameOf(worlds.link(i), worlds.key(i), form))
      brought <- held.bring(names, isCancelled): i =>
        episodes.timetable(worlds.link(numbers(i)), worlds.key(numbers(i)), form)
    do
      fly(form, some, some.map(teams), numbers, brought, held.layout, each, into)
      flown += some.length * numbers.length
      onProgress(flown)
    Accelerated(flown, GpuEpisodes.worldsOf(unknown, each))

  private def isOnGpu(team: PreparedTeam) = team.form != null && team.form.refusedByGpu.isEmpty

  private def episodesFor(form: TeamForm): GpuEpisodes =
    val shows = form.policies.isInstanceOf[TeamLanes]
    onGpu.getOrElseUpdate((form.count, shows), GpuEpisodes(gpu, form.count, shows, threads, MostBytes))

  /** @param candidates indices of the teams
    * @param numbers indices of the episodes
    */
  private def fly(
      form: TeamForm,
      candidates: Array[Int],
      teams: Array[PreparedTeam],
      numbers: Array[Int],
      flown: Vector[GpuEpisodes.Held],
      layout: GpuLayout,
      each: Int,
      into: TeamOutcomes
  ): Unit =
    val kernel = kernels.getOrElseUpdate((form, layout), kernelOf(form, teams(0), layout))
    val came   = kernel.fly(flown, teams)
    for (episode, at) <- flown.zipWithIndex do
      var (score, effort) = (0, form.scores.initial.size)
      for (told, ofEffort) <- into.values.zip(form.efforts) do
        def first(place: Int)                      = (place * flown.size + at) * teams.length
        def tell(from: Int)(value: Float => Float) = for i <- teams.indices do
          told(candidates(i) * each + numbers(at)) = value(came(from + i))
        if ofEffort.isDefined then
          tell(first(effort))(identity)
          effort += 1
        else
          val outcome = GpuFlightKernel.Outcome(form.scores, score, episode.scoredAtS)
          tell(first(outcome.place))(outcome(_))
          score += 1

  private def kernelOf(form: TeamForm, first: PreparedTeam, layout: GpuLayout): GpuFlightKernel =
    form.policies match
      case two: OpponentLanes =>
        GpuOpponentKernel(gpu, first.vehicles, vehicle, prediction, form, two, layout)
      case team: TeamLanes =>
        GpuTeamKernel(gpu, first.vehicles, vehicle, prediction, team, form.scores, layout)

private object GpuTeams:
  /** Number of candidates whose policies a thread reads in a row. */
  private val Chunk = 256

  /** Maximum number of decisions in one part: some tenths of a second on a GPU, or seconds if vehicles move
    * in steps.
    */
  private val MostDecisions = 2e9

  /** Bytes per decision of an episode, of which its operations take about half. */
  private val BytesOfDecision = 512

  /** Maximum size of the episodes in a GPU's memory, bytes. */
  private val MostBytes = 1L << 30
