package skein.formula

import java.lang.reflect.{Method, Modifier}
import scala.collection.mutable
import scala.util.control.NonFatal
import skein.formula.Value.*

/** The computation of an ordinary method as data, from [[inputs]] and [[parameters]] to [[outputs]].
  * `skein.simd.LaneCompiler` and other compilers can compile it.
  *
  * @param inputs names of the numbers in the arguments
  * @param outputs the result's nodes with their names; a single number is called `answer`
  * @param parameters names of the doubles inside the object that the method reads, for example `.weights(3)`
  */
final class Formula private (
    val trace: Trace,
    val inputs: Vector[String],
    val outputs: Vector[(String, Node)],
    val parameters: Vector[String],
    isLike: AnyRef => Boolean,
    numbersOf: AnyRef => Array[Double]
):
  /** Whether another object's method differs from this formula only in parameter values. */
  def fits(other: AnyRef): Boolean = isLike(other)

  /** The parameters of an object that [[fits]]. */
  def parametersOf(other: AnyRef): Array[Double] = numbersOf(other)

  /** Evaluates the formula in doubles. Slow; bit-identical to the method. */
  def evaluate(input: Array[Double], parameters: Array[Double]): Array[Double] =
    Evaluation(outputs.map(_._2))(input, parameters)

object Formula:

  /** Traces an object's method.
    *
    * @param method name of the method
    * @param sizes lengths of arguments that are arrays, keyed by name
    * @param arguments types of its arguments, needed if the class has several methods of that name
    * @param known constant arguments or fields that are not doubles, keyed by name. If the result contains
    *   them, only its other fields become outputs
    * @return Left says why the method cannot be traced
    */
  def of(
      target: AnyRef,
      method: String,
      sizes: Map[String, Int] = Map.empty,
      arguments: Option[Seq[Class[?]]] = None,
      known: Map[String, Any] = Map.empty
  ): Either[Untraceable, Formula] = target match
    case known: KnownFormula => Right(known.formula)
    case _                   => named(target, method, sizes, arguments, known)

  /** Creates a formula from an existing graph.
    *
    * @param isLike whether an object has this graph
    * @param numbersOf the parameters of such an object
    */
  private[skein] def ofGraph(
      trace: Trace,
      inputs: Vector[String],
      outputs: Vector[(String, Node)],
      parameters: Vector[String]
  )(isLike: AnyRef => Boolean)(numbersOf: AnyRef => Array[Double]): Formula =
    Formula(trace, inputs, outputs, parameters, isLike, numbersOf)

  private def lifted(
      trace: Trace,
      inputs: Vector[String],
      outputs: Vector[(String, Node)],
      lifter: Lifter,
      of: Class[?]
  ): Formula =
    val check  = FormCheck(lifter.guards)
    val reader = NumberReader(lifter.parameters)
    Formula(
      trace,
      inputs,
      outputs,
      lifter.parameters.map(_.toString),
      other => (other.getClass eq of) && check.fits(other),
      reader.read(_)
    )

  private def named(
      target: AnyRef,
      method: String,
      sizes: Map[String, Int],
      arguments: Option[Seq[Class[?]]],
      known: Map[String, Any]
  ): Either[Untraceable, Formula] =
    val candidates = methodsOf(target.getClass).filter: each =>
      each.getName == method && !Modifier.isAbstract(each.getModifiers) && !each.isBridge &&
        arguments.forall(_ == each.getParameterTypes.toSeq)
    candidates.distinctBy(each =>
      java.lang.invoke.MethodType.methodType(each.getReturnType, each.getParameterTypes)
    ) match
      case Seq(one) => of(target, one, sizes, known)
      case Seq()    => Left(Untraceable(s"${target.getClass.getName} has no method $method"))
      case _        => Left(Untraceable(s"${target.getClass.getName} has several methods $method"))

  private def of(
      target: AnyRef,
      method: Method,
      sizes: Map[String, Int],
      known: Map[String, Any]
  ): Either[Untraceable, Formula] =
    try
      val loader = Option(target.getClass.getClassLoader).getOrElse(ClassLoader.getSystemClassLoader)
      val files  = ClassFiles(loader)
      val trace  = Trace()
      val lifter = Lifter(files, trace)
      val names  = mutable.ArrayBuffer.empty[String]
      val told   = mutable.HashMap.empty[Value, Set[(String, Value)]].withDefaultValue(Set.empty)

      def input(name: String): Node =
        names += name
        trace.input(names.size - 1)

      def argument(kind: Class[?], name: String): Value =
        if kind == classOf[Double] then Number(input(name))
        else if known.contains(name) then
          known(name) match
            case null           => Null
            case number: Int    => Whole(trace.const(number))
            case truth: Boolean => Whole(trace.const(if truth then 1 else 0))
            case other: AnyRef  => Known(other, None)
        else if kind == classOf[Object] then
          throw Untraceable(s"the type of the argument $name is not known; make it a case class of doubles")
        else if kind == classOf[Array[Double]] then
          val size = sizes.getOrElse(name, throw Untraceable(s"how many numbers has the argument $name?"))
          lifter.make(Thing.Elements(Vector.tabulate(size)(i => Number(input(s"$name($i)")))))
        else if kind.isPrimitive || kind.isArray || kind.isInterface || Modifier.isAbstract(kind.getModifiers)
        then
          throw Untraceable(
            s"the argument $name is a ${kind.getName}; expected a Double, doubles, or a class of them"
          )
        else
          val fields = Shape
            .fieldsOf(kind)
            .map(each => each.getName -> argument(each.getType, s"$name.${each.getName}"))
            .toMap
          val made = lifter.make(Thing.Record(ClassFiles.nameOf(kind), fields))
          told(made) = fields.filter((field, _) => known.contains(s"$name.$field")).toSet
          made

      val descriptor = java.lang.invoke.MethodType
        .methodType(method.getReturnType, method.getParameterTypes)
        .toMethodDescriptorString
      val owner = ClassFiles.nameOf(target.getClass)
      val code  = files
        .method(owner, method.getName, descriptor)
        .getOrElse(
          throw Untraceable(
            s"${target.getClass.getName} has no class file: a lambda expression? A class has one"
          )
        )
      val args = method.getParameters.toVector.map(each => argument(each.getType, each.getName))
      val self =
        if code.isStatic then Vector.empty else Vector(Known(target, Some(Path(None, PathStep.Itself))))
      val answer = lifter.call(code, self ++ args)

      def outputsOf(value: Value, name: String): Vector[(String, Node)] = value match
        case Number(node)        => Vector(name -> node)
        case Boxed(Number(node)) => Vector(name -> node)
        case Made(id)            =>
          lifter.thing(id) match
            case Thing.Record(className, fields) =>
              ofFields(className, fields.filterNot(told(value)), name)
            case Thing.Either(className, fields) => ofFields(className, fields, name)
            case Thing.Elements(values, _)       =>
              values.zipWithIndex.flatMap((each, i) => outputsOf(each, s"$name($i)"))
            case _ => throw Untraceable("it answers with a closure")
        case Known(_, _) => throw Untraceable(s"$name is an object that was there before; make it of numbers")
        case _           => throw Untraceable(s"$name is no double")

      def ofFields(className: String, fields: Map[String, Value], name: String): Vector[(String, Node)] =
        Shape.fieldsOf(files.load(className))
          .map(_.getName)
          // A pair of doubles has a specialised class, whose inherited fields are empty.
          .filter(each => fields.contains(each) && fields(each) != Null)
          .flatMap(each => outputsOf(fields(each), if name == Answer then each else s"$name.$each"))

      Right(lifted(trace, names.toVector, outputsOf(answer, Answer), lifter, target.getClass))
    catch
      case refused: Untraceable => Left(refused)
      case NonFatal(other)      => Left(Untraceable(s"${target.getClass.getName}.${method.getName}: $other"))

  /** Traces an object's method for arguments like the examples.
    *
    * @param descriptor the method's descriptor, as in class files
    * @param loader finds all classes that the method uses
    * @param read extracts the outputs from the result
    * @return the formula and the result of `read`, or why the method cannot be traced
    */
  def ofExamples[A](
      target: AnyRef,
      method: String,
      descriptor: String,
      arguments: Seq[Example],
      loader: ClassLoader
  )(read: (Trace, Answer) => (Vector[(String, Node)], A)): Either[Untraceable, (Formula, A)] =
    try
      val files  = ClassFiles(loader)
      val trace  = Trace()
      val lifter = Lifter(files, trace)
      val names  = mutable.ArrayBuffer.empty[String]
      val args   = arguments.map: argument =>
        lifter.argument(
          argument,
          path =>
            names += path.toString
            trace.input(names.size - 1)
        )
      val code = files
        .method(ClassFiles.nameOf(target.getClass), method, descriptor)
        .getOrElse(throw Untraceable(s"${target.getClass.getName} has no method $method"))
      val answer = lifter.call(code, Known(target, Some(Path(None, PathStep.Itself))) +: args.toVector)
      val (outputs, came) = read(trace, skein.formula.Answer(answer, lifter))
      Right((lifted(trace, names.toVector, outputs, lifter, target.getClass), came))
    catch
      case refused: Untraceable => Left(refused)
      case NonFatal(other)      => Left(Untraceable(s"${target.getClass.getName}.$method: $other"))

  private val Answer = "answer"

  private def methodsOf(of: Class[?]): Vector[Method] =
    Iterator.iterate[Class[?]](of)(
      _.getSuperclass
    ).takeWhile(_ != null).flatMap(_.getDeclaredMethods).toVector ++
      of.getMethods

/** An object whose method already is a formula, so that its bytecode is not read. */
private[skein] trait KnownFormula:
  def formula: Formula
