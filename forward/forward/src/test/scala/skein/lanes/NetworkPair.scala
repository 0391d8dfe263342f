package skein.lanes

import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import skein.policy.{NeuralPolicy, NeuralShape, Role}
import skein.scenario.{Measure, PaperDuel, Scenario}

/** The paper's duel, pursued by a network of 16 and 16 neurons. */
private final case class NetworkPair(parameters: Vector[Double]) extends Scenario:
  private val policy = NeuralPolicy(NeuralShape(Vector(16, 16)), parameters)

  def agents = PaperDuel().agents.map(agent =>
    if agent.role == Role.Pursuer then agent.copy(policy = policy) else agent
  )

  override def measures: Vector[Measure] = PaperDuel().measures

private object NetworkPair:

  /** By the parameters in a folder's `network.txt`, one a line. */
  def of(folder: Path): NetworkPair =
    NetworkPair(Files.readAllLines(folder.resolve("network.txt")).asScala.map(_.toDouble).toVector)
