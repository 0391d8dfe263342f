package skein.search

import skein.settings.PolicyFile

/** The baseline with which a search's result is compared, on equal episodes.
  *
  * @param word the word for its line in the output
  * @param name the name in tables
  * @param parameters name and value of each parameter, one per axis of a space of its own
  * @param label name and parameters, for people
  */
final case class Baseline(word: String, name: String, parameters: Vector[(String, Double)], label: String):
  def candidate: Vector[Double] = parameters.map(_._2)

object Baseline:
  def of(paper: PolicyFile): Baseline =
    Baseline(
      "paper",
      paper.family.name,
      paper.family.space.axes.map(_.name).zip(paper.parameters),
      paper.label
    )
