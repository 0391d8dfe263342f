package skein.formula

import java.lang.classfile.Opcode
import java.lang.classfile.instruction.InvokeDynamicInstruction
import java.lang.constant.{ClassDesc, MethodTypeDesc}
import scala.jdk.CollectionConverters.*
import skein.formula.Thing.*
import skein.formula.Value.*

/** Resolves method calls during tracing: traces into methods, applies closures, and evaluates the JDK's and
  * Scala's operations on numbers, boxes and arrays itself.
  *
  * @param enter traces a method
  * @param either joins two values by a condition
  */
private[formula] final class Calls(
    files: ClassFiles,
    trace: Trace,
    numbers: Arithmetic,
    objects: Objects,
    enter: (MethodCode, Vector[Value]) => Value,
    either: (Node, => Value, => Value) => Value,
    refuse: String => Nothing
):
  import Calls.*
  import numbers.{asNumber, decided, known, number, settled, unboxed}
  import objects.*

  def invoked(
      owner: String,
      name: String,
      desc: MethodTypeDesc,
      kind: Opcode,
      args: Vector[Value]
  ): Value =
    intrinsic(owner, name, desc.descriptorString, args).getOrElse:
      val dispatches = kind == Opcode.INVOKEVIRTUAL || kind == Opcode.INVOKEINTERFACE
      val receiver   = if kind == Opcode.INVOKESTATIC then None else Some(settled(args.head))
      if receiver.contains(Null) then refuse(s"it calls $name of nothing")
      receiver match
        case Some(OneOf(condition, yes, no)) =>
          either(
            condition,
            invoked(owner, name, desc, kind, yes +: args.tail),
            invoked(owner, name, desc, kind, no +: args.tail)
          )
        case Some(Made(id)) if dispatches && thing(id).isInstanceOf[Closure] =>
          val closure = thing(id).asInstanceOf[Closure]
          if closure.method == name then
            applied(closure, args.tail, desc.returnType)
          else into(closure.interface, name, desc, args)
        case Some(value) if dispatches => into(classOfThing(value).getOrElse(owner), name, desc, args)
        case _                         => into(owner, name, desc, args)

  private def hasBody(owner: String, name: String, desc: MethodTypeDesc) =
    files.method(owner, name, desc.descriptorString).isDefined

  private def into(owner: String, name: String, desc: MethodTypeDesc, args: Vector[Value]): Value =
    val where = owner.replace('/', '.')
    if (owner.startsWith("java/") || owner.startsWith("jdk/")) && !Arithmetical(owner) then
      refuse(s"it calls $where.$name, which is not arithmetic")
    files.method(owner, name, desc.descriptorString) match
      case Some(code)                              => enter(code, args)
      case None if files.classModel(owner).isEmpty =>
        refuse(s"it calls $name of $where, which has no class file: a lambda expression? A class has one")
      case None => refuse(s"it calls $where.$name, which has no bytecode")

  def closure(dynamic: InvokeDynamicInstruction, captured: Vector[Value]): Value =
    if dynamic.bootstrapMethod.owner.descriptorString != "Ljava/lang/invoke/LambdaMetafactory;" then
      Known("a text", None)
    else
      dynamic.bootstrapArgs.get(1) match
        case handle: java.lang.constant.DirectMethodHandleDesc =>
          import java.lang.constant.DirectMethodHandleDesc.Kind as Handle
          val kind = handle.kind match
            case Handle.STATIC | Handle.INTERFACE_STATIC => Thing.Kind.Static
            case Handle.CONSTRUCTOR                      => Thing.Kind.Constructor
            case _                                       => Thing.Kind.Instance
          val impl = Impl(
            ClassFiles.internalName(handle.owner),
            handle.methodName,
            handle.lookupDescriptor,
            kind
          )
          val interface = ClassFiles.internalName(dynamic.typeSymbol.returnType)
          make(Closure(interface, dynamic.name.stringValue, impl, captured))
        case _ => refuse("a closure of an unknown kind")

  private def applied(closure: Closure, args: Vector[Value], answers: ClassDesc): Value =
    val impl          = closure.impl
    val desc          = MethodTypeDesc.ofDescriptor(impl.descriptor)
    val all           = closure.captured ++ args
    val (first, rest) = if impl.kind == Thing.Kind.Instance then all.splitAt(1) else (Vector.empty, all)
    val fitting       = rest.zip(desc.parameterList.asScala).map(fit)
    val answer        = impl.kind match
      case Thing.Kind.Static   => into(impl.owner, impl.name, desc, fitting)
      case Thing.Kind.Instance =>
        val owner = classOfThing(decided(first.head)).getOrElse(impl.owner)
        into(
          if hasBody(impl.owner, impl.name, desc) then impl.owner else owner,
          impl.name,
          desc,
          first ++ fitting
        )
      case Thing.Kind.Constructor =>
        val made = make(Record(impl.owner, Map.empty))
        into(impl.owner, "<init>", desc, made +: fitting): Unit
        made
    fit(answer, answers)

  private def fit(value: Value, to: ClassDesc): Value = value match
    case Boxed(inner) if to.isPrimitive                       => inner
    case _: (Number | Whole | Long | Time) if !to.isPrimitive => Boxed(value)
    case OneOf(condition, yes, no) => numbers.either(condition, fit(yes, to), fit(no, to))
    case _                         => value

  private def intrinsic(owner: String, name: String, desc: String, args: Vector[Value]): Option[Value] =
    (owner, name) match
      case ("java/lang/Math" | "java/lang/StrictMath", _) => numbers.function(owner, name, desc, args)
      // The exception is thrown later, and refused then.
      case (thrown, "<init>") if classOf[Throwable].isAssignableFrom(files.load(thrown)) => Some(Null)
      case ("java/lang/Object", "<init>")                                                => Some(Null)
      case ("java/lang/System", "arraycopy")                                             => copied(args)
      case ("scala/Array$", "copy")                                                      => copied(args.tail)
      case ("scala/reflect/ClassTag$", "apply")                                          => args(1) match
          case Known(of: Class[?], _) => Some(Known(scala.reflect.ClassTag(of), None))
          case _                      => None
      case ("scala/runtime/ScalaRunTime$", "array_length") => Some(Whole(trace.const(lengthOf(args(1)))))
      case ("scala/runtime/ScalaRunTime$", "array_apply")  =>
        Some(inObject(element(args(1), known(args(2), "an index"))))
      case ("scala/runtime/ScalaRunTime$", "array_update") =>
        update(args(1), known(args(2), "an index"), args(3))
        Some(Null)
      case (array, "clone") if array.startsWith("[") =>
        Some(make(Elements(Vector.tabulate(lengthOf(args(0)))(element(args(0), _)))))
      case ("java/lang/Double", "compare")     => Some(numbers.order(number(args(0)), number(args(1))))
      case ("java/lang/Long", "compare")       => Some(numbers.orderOf(args(0), args(1)))
      case ("java/util/Objects", "equals")     => Some(Whole(asNumber(equal(args(0), args(1)))))
      case ("java/util/Arrays", "copyOf")      => Some(part(args(0), 0, known(args(1), "a length")))
      case ("java/util/Arrays", "copyOfRange") =>
        Some(part(args(0), known(args(1), "an index"), known(args(2), "an index")))
      case ("java/lang/Double" | "java/lang/Integer" | "java/lang/Boolean" | "java/lang/Long", unboxing)
          if unboxing.endsWith("Value") && desc.startsWith("()") =>
        Some(unboxed(args(0)))
      case ("java/lang/Integer" | "java/lang/Long", _) if desc.forall("IJ()".contains(_)) =>
        Some(ofKnown(owner, name, desc, args))
      case ("java/lang/Double", "isNaN") =>
        val x = number(if desc == "(D)Z" then args(0) else unboxed(args(0)))
        Some(Whole(asNumber(trace.not(trace.equal(x, x)))))
      case ("java/lang/Double" | "java/lang/Integer" | "java/lang/Boolean" | "java/lang/Long", "valueOf")
          if desc.length > 3 && desc(2) == ')' =>
        Some(Boxed(args(0)))
      case ("scala/runtime/BoxesRunTime", "boxToDouble" | "boxToInteger" | "boxToBoolean" | "boxToLong") =>
        Some(Boxed(args(0)))
      case (
            "scala/runtime/BoxesRunTime",
            "unboxToDouble" | "unboxToInt" | "unboxToBoolean" | "unboxToLong"
          ) =>
        Some(unboxed(args.last))
      case _ => None

  private def equal(a: Value, b: Value): Node =
    numbers.asked(a): one =>
      numbers.asked(b): other =>
        if one == other then trace.always
        else if one == Null || other == Null then trace.never
        else
          val answer = invoked("java/lang/Object", "equals", Equals, Opcode.INVOKEVIRTUAL, Vector(one, other))
          trace.not(trace.equal(numbers.whole(answer), trace.const(0)))

  /** A new array with a range of another array's elements. Elements beyond the other array's end are zero or
    * null.
    */
  private def part(array: Value, from: Int, until: Int): Value =
    val length = lengthOf(array)
    def none   = if length == 0 then Null else zeroLike(element(array, 0))
    make(Elements(Vector.tabulate(until - from): i =>
      if from + i < length then element(array, from + i) else none))

  private def zeroLike(value: Value): Value = value match
    case _: Number => Number(trace.const(0))
    case _: Whole  => Whole(trace.const(0))
    case _: Long   => Long(0)
    case _         => Null

  /** Calls a static method whose arguments are known integers. */
  private def ofKnown(owner: String, name: String, desc: String, args: Vector[Value]): Value =
    val numbers = args.map:
      case Long(number) => java.lang.Long.valueOf(number)
      case value        => java.lang.Integer.valueOf(known(value, s"what $name is asked"))
    val types  = java.lang.invoke.MethodType.fromMethodDescriptorString(desc, null)
    val method = Class.forName(owner.replace('/', '.')).getMethod(name, types.parameterArray*)
    method.invoke(null, numbers*) match
      case number: java.lang.Long => Long(number)
      case number                 => Whole(trace.const(Value.wholeOf(number)))

private object Calls:
  private val Equals = MethodTypeDesc.ofDescriptor("(Ljava/lang/Object;)Z")

  /** JDK classes whose methods may be traced into. */
  private val Arithmetical = Set("java/lang/Math", "java/lang/StrictMath", "java/lang/Object")
