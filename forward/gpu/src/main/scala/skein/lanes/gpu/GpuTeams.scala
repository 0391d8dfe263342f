package skein.lanes.gpu

import scala.collection.mutable
import skein.forward.Delays
import skein.gpu.Gpu
import skein.lanes.{Accelerated, AcceleratedTeams, PreparedTeam, TeamForm, TeamOutcomes, TeamWorlds}
import skein.lanes.timetable.Timetable

/** Simulates teams' candidates on a GPU, each in all episodes, by [[GpuTeamKernel]]. Mutable; one call at a
  * time.
  *
  * @param threads that make timetables
  */
private[lanes] final class GpuTeams(
    gpu: Gpu,
    vehicle: GpuVehicle.Kind,
    prediction: Option[GpuPrediction.Kind],
    threads: Int,
    periodS: Double,
    timetable: (Delays, Int, TeamForm) => Timetable
) extends AcceleratedTeams:
  private val onGpu   = mutable.HashMap.empty[Int, GpuEpisodes]
  private val kernels = mutable.HashMap.empty[(TeamForm, GpuLayout), GpuTeamKernel]

  def fly(
      worlds: TeamWorlds,
      prepared: Int => PreparedTeam,
      into: TeamOutcomes,
      onProgress: Int => Unit,
      isCancelled: () => Boolean
  ): Accelerated =
    val each                   = worlds.episodesOfEach
    def candidate(number: Int) = prepared(number * each)
    val (known, unknown)       =
      Array.range(0, GpuEpisodes.candidatesOf(worlds)).partition(candidate(_).form.exists(_.team.isPlain))
    val flown = GpuParts(known, each, onProgress, isCancelled)
      .fly(candidate(_).form.get, form => form.team.count * form.durationS / periodS):
        (form, some, numbers) =>
          val episodes = onGpu.getOrElseUpdate(
            form.team.count,
            GpuEpisodes(gpu, form.team.count, shows = true, threads, GpuParts.MostBytes)
          )
          val names   = numbers.toVector.map(i => (worlds.link(i), worlds.key(i), form.durationS))
          val brought = episodes.bring(names, isCancelled): i =>
            timetable(worlds.link(numbers(i)), worlds.key(numbers(i)), form)
          brought
            .map: flown =>
              val came = fly(form, some.map(candidate), flown, episodes.layout)
              for
                (judged, told) <- form.scores.judged.indices.zip(into.values);
                (episode, at)  <- flown.zipWithIndex
              do
                val outcome = GpuFlightKernel.Outcome(form.scores, judged, episode.scoredAtS)
                val first   = (outcome.place * flown.size + at) * some.length
                for i <- some.indices do told(some(i) * each + numbers(at)) = outcome(came(first + i))
            .isDefined
    Accelerated(flown, GpuEpisodes.worldsOf(unknown, each))

  private def fly(
      form: TeamForm,
      candidates: Array[PreparedTeam],
      episodes: Vector[GpuEpisodes.Held],
      layout: GpuLayout
  ): Array[Float] =
    val kernel = kernels.getOrElseUpdate(
      (form, layout),
      GpuTeamKernel(gpu, candidates(0).vehicles, vehicle, prediction, form.team, form.scores, layout)
    )
    val numbers =
      candidates.map(each =>
        GpuTeamKernel.numbersOf(each.vehicles, each.ofPolicies.map(_.parameters), each.ofQuantities)
      )
    kernel.fly(episodes, candidates.length, Vector((numbers.flatten, candidates.indices.toArray)), 0)
