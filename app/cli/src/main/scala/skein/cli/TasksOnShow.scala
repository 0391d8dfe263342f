package skein.cli

import skein.budget.BudgetAxes
import skein.optimise.{SearchState, RunningStats}
import skein.search.Landscape
import skein.training.{LearnSetup, LearnState}
import skein.view.TaskShow
import skein.view.TaskShow.Axis

/** A search, for its viewers.
  *
  * @param expected episodes
  * @param measured what candidates are compared by, with its unit
  */
private[cli] final class SearchOnShow(show: TaskShow, title: String, expected: Long, measured: String):
  private var best = Vector.empty[(Double, Double)]

  def step(state: SearchState, line: String): Unit =
    show.progress(title, state.flown, expected, "episodes", line)
    for leader <- state.best do
      val point = (state.flown.toDouble, leader.tally.mean)
      // Where nothing got better, the line gets longer.
      val flat = best.takeRight(2).map(_._2) == Vector.fill(2)(point._2)
      best = (if flat then best.init else best) :+ point
      show.curve("The best so far", "episodes flown", measured, best)

  def landscape(land: Landscape): Unit =
    val means = land.cells.map(_.map(_.mean))
    val x     = land.space.axes(land.x).name
    land.y match
      case None    => show.curve("Around the best", x, measured, land.xs.zip(means.head))
      case Some(y) => show.landscape(
          s"$measured around the best",
          Axis(x, land.xs),
          Axis(land.space.axes(y).name, land.ys),
          means.map(_.map(Some(_)))
        )

/** Learning, for its viewers. */
private[cli] final class LearnOnShow(show: TaskShow, setup: LearnSetup):
  def step(state: LearnState, line: String): Unit =
    show.progress(
      setup.title,
      state.rounds * setup.stepsOfRound,
      setup.rounds * setup.stepsOfRound,
      "steps",
      line
    )
    if state.scores.nonEmpty then
      show.curve(
        "The policy as it grows",
        "steps of all environments",
        setup.measure,
        state.scores.map(score =>
          (score.steps.toDouble, score.mean)
        )
      )

/** A latency budget's map, for its viewers. */
private[cli] final class BudgetOnShow(
    show: TaskShow,
    title: String,
    expected: Long,
    axes: BudgetAxes,
    measured: String
):
  def flown(episodes: Long): Unit = show.progress(title, episodes, expected, "episodes", "")

  def rows(known: Vector[Vector[Option[RunningStats]]]): Unit = show.landscape(
    s"$measured, $title",
    Axis("mean round trip, ms", axes.meansMs),
    Axis("jitter, ms", axes.jittersMs),
    known.map(_.map(_.map(_.mean)))
  )
