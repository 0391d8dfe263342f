package skein.simulator

import scala.collection.mutable
import skein.units.Instant
import upickle.default.Writer

/** A list of functions, each added by the statement that describes it. */
private[simulator] abstract class MethodList:
  private val added = mutable.ListBuffer.empty[ServerMethod]

  def all: Seq[ServerMethod] = added.toSeq

  protected def add(method: ServerMethod): Unit = added += method

  protected def none(name: String)(run: Simulated => CallOutcome): Unit =
    add(ServerMethod(name, List.empty, (simulation, _) => run(simulation)))

  protected def one[A](name: String)(run: (Simulated, A) => CallOutcome)(using argument: Argument[A]): Unit =
    add(ServerMethod(
      name,
      List(argument),
      (simulation, values) => run(simulation, values.asInstanceOf[Tuple1[A]]._1)
    ))

  /** A function of several parameters, read as the tuple that `run` takes. */
  protected inline def many[T <: Tuple](name: String)(run: (Simulated, T) => CallOutcome): Unit =
    add(ServerMethod(name, Argument.each[T], (simulation, values) => run(simulation, values.asInstanceOf[T])))

  /** A function that reads the current state of a vehicle found by its name. */
  protected def read[V, A: Writer](
      method: String,
      find: (Simulated, String) => ((Int, V) => CallOutcome) => CallOutcome
  )(value: (V, Instant) => A): Unit =
    one[String](method): (simulation, name) =>
      find(simulation, name)((_, vehicle) =>
        ServerMethod.answer(value(vehicle, simulation.world.now))
      )
