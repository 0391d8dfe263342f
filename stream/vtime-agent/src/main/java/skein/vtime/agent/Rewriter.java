package skein.vtime.agent;

import static java.lang.constant.ConstantDescs.*;

import java.lang.classfile.ClassFile;
import java.lang.classfile.ClassHierarchyResolver;
import java.lang.classfile.ClassModel;
import java.lang.classfile.ClassTransform;
import java.lang.classfile.CodeBuilder;
import java.lang.classfile.CodeElement;
import java.lang.classfile.CodeTransform;
import java.lang.classfile.MethodModel;
import java.lang.classfile.Opcode;
import java.lang.classfile.TypeKind;
import java.lang.classfile.constantpool.MemberRefEntry;
import java.lang.classfile.instruction.InvokeDynamicInstruction;
import java.lang.classfile.instruction.InvokeInstruction;
import java.lang.constant.ClassDesc;
import java.lang.constant.ConstantDesc;
import java.lang.constant.DirectMethodHandleDesc;
import java.lang.constant.DirectMethodHandleDesc.Kind;
import java.lang.constant.DynamicCallSiteDesc;
import java.lang.constant.MethodHandleDesc;
import java.lang.constant.MethodTypeDesc;
import java.lang.instrument.ClassFileTransformer;
import java.lang.invoke.MethodHandles;
import java.lang.invoke.MethodType;
import java.lang.reflect.Modifier;
import java.security.ProtectionDomain;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import java.util.Set;
import java.util.function.BiConsumer;
import java.util.random.RandomGenerator;

/** Redirects the calls listed here, inside the given packages, to {@link Redirect}. */
final class Rewriter implements ClassFileTransformer {
  private static final ClassDesc REDIRECT = Redirect.class.describeConstable().orElseThrow();
  private static final ClassDesc DRAWS = ClassDesc.of("skein.vtime.agent.Draws");

  /** The class file of {@link #DRAWS}, which has no source. */
  static final byte[] DRAWS_CLASS;

  private static final ClassDesc RANDOM = ClassDesc.of("java.util.concurrent.ThreadLocalRandom");
  private static final ClassDesc JAVA_RANDOM = ClassDesc.of("java.util.Random");
  private static final ClassDesc DURATION = ClassDesc.of("java.time.Duration");
  private static final ClassDesc ZONE = ClassDesc.of("java.time.ZoneId");
  private static final ClassDesc CLOCK = ClassDesc.of("java.time.Clock");
  private static final ClassDesc TIME_UNIT = ClassDesc.of("java.util.concurrent.TimeUnit");
  private static final ClassDesc GENERATOR = ClassDesc.of("java.util.random.RandomGenerator");

  /** Methods as call sites name them: {@code owner.name descriptor}. */
  private static final Map<String, Target> CALLS = new HashMap<>();

  /** Constructors, named by owner and descriptor. */
  private static final Map<String, Making> MAKINGS = new HashMap<>();

  /**
   * Methods that hand a task to an execution context: unchanged, but the environment must permit it first.
   */
  private static final Set<String> SUBMISSIONS =
      Set.of(
          "scala/concurrent/ExecutionContext.execute(Ljava/lang/Runnable;)V",
          "scala/concurrent/ExecutionContextExecutor.execute(Ljava/lang/Runnable;)V",
          "java/util/concurrent/Executor.execute(Ljava/lang/Runnable;)V");

  /** Pekko numbers these actors per JVM, so each name is replaced by one numbered per environment. */
  private static final String SUPERVISOR_NAME =
      "org/apache/pekko/stream/impl/StreamSupervisor$.nextName()Ljava/lang/String;";

  /** A shared kill switch calls its streams in the order of these objects' identity hash codes. */
  private static final String KILL_SWITCH_LISTENER = "org/apache/pekko/stream/TerminationSignal$Listener";

  /** Scala's generator, which without a seed creates a generator of Java. */
  private static final String SCALA_RANDOM = "scala/util/Random";
  private static final String UNSEEDED = "java/util/Random.<init>()V";

  private record Target(ClassDesc owner, String name, MethodTypeDesc type) {}

  /** The parameter of the replacing constructor, and the factory for method references. */
  private record Making(Target parameter, Target factory) {}

  static {
    redirectStatic("java.lang.System", "nanoTime", "nanoTime", MethodTypeDesc.of(CD_long));
    redirectStatic("java.lang.System", "currentTimeMillis", "currentTimeMillis", MethodTypeDesc.of(CD_long));
    var instant = ClassDesc.of("java.time.Instant");
    redirectStatic("java.time.Instant", "now", "instantNow", MethodTypeDesc.of(instant));
    for (var type : List.of("LocalDate", "LocalTime", "LocalDateTime", "OffsetDateTime", "ZonedDateTime")) {
      var moment = ClassDesc.of("java.time." + type);
      var target = Character.toLowerCase(type.charAt(0)) + type.substring(1) + "Now";
      redirectStatic("java.time." + type, "now", target, MethodTypeDesc.of(moment));
      redirectStatic("java.time." + type, "now", target, MethodTypeDesc.of(moment, ZONE));
    }
    redirectStatic("java.time.Clock", "systemUTC", "clockUtc", MethodTypeDesc.of(CLOCK));
    redirectStatic("java.time.Clock", "systemDefaultZone", "clock", MethodTypeDesc.of(CLOCK));
    redirectStatic("java.time.Clock", "system", "clock", MethodTypeDesc.of(CLOCK, ZONE));
    redirectMaking("java.util.Date", "currentTimeMillis", "newDate");
    redirectMaking("java.util.Random", "seed", "newRandom");
    redirectMaking("java.util.SplittableRandom", "seed", "newSplittableRandom");
    redirectStatic("java.util.random.RandomGenerator", "getDefault", "defaultGenerator", MethodTypeDesc.of(GENERATOR));
    redirectStatic("java.lang.Math", "random", "mathRandom", MethodTypeDesc.of(CD_double));
    redirectStatic("java.util.UUID", "randomUUID", "randomUuid", MethodTypeDesc.of(ClassDesc.of("java.util.UUID")));
    redirectStatic("java.lang.Thread", "sleep", "sleep", MethodTypeDesc.of(CD_void, CD_long));
    redirectStatic("java.lang.Thread", "sleep", "sleep", MethodTypeDesc.of(CD_void, DURATION));
    redirectStatic("java.lang.Thread", "sleep", "sleep", MethodTypeDesc.of(CD_void, CD_long, CD_int));
    redirectInstance(TIME_UNIT, "sleep", MethodTypeDesc.of(CD_void, CD_long));
    DRAWS_CLASS = redirectDraws();
  }

  private static void redirectStatic(String owner, String name, String target, MethodTypeDesc type) {
    CALLS.put(owner.replace('.', '/') + "." + name + type.descriptorString(), new Target(REDIRECT, target, type));
  }

  private static void redirectInstance(ClassDesc owner, String name, MethodTypeDesc type) {
    var target = new Target(REDIRECT, name, type.insertParameterTypes(0, owner));
    CALLS.put(internalName(owner) + "." + name + type.descriptorString(), target);
  }

  /**
   * Replaces a class's constructor without parameters, which depends on time or chance, by that with a {@code
   * long}.
   */
  private static void redirectMaking(String owner, String parameter, String factory) {
    var made = ClassDesc.of(owner);
    var target =
        new Making(
            new Target(REDIRECT, parameter, MethodTypeDesc.of(CD_long)),
            new Target(REDIRECT, factory, MethodTypeDesc.of(made)));
    MAKINGS.put(internalName(made) + ".<init>()V", target);
  }

  /**
   * {@code ThreadLocalRandom} is final, so each draw from it is replaced instead of the generator: by a
   * static method of a generated class.
   *
   * @return that class, {@link #DRAWS}
   */
  private static byte[] redirectDraws() {
    return ClassFile.of().build(DRAWS, made -> {
      made.withFlags(ClassFile.ACC_PUBLIC | ClassFile.ACC_FINAL);
      for (var draw : RandomGenerator.class.getMethods()) {
        var type = MethodType.methodType(draw.getReturnType(), draw.getParameterTypes()).describeConstable().orElseThrow();
        var target = new Target(DRAWS, draw.getName(), type.insertParameterTypes(0, RANDOM));
        if (!Modifier.isStatic(draw.getModifiers())) {
          CALLS.put(internalName(RANDOM) + "." + draw.getName() + type.descriptorString(), target);
          made.withMethodBody(
              target.name(), target.type(), ClassFile.ACC_PUBLIC | ClassFile.ACC_STATIC, code -> draw(code, target.name(), type));
        }
      }
    });
  }

  /** Defines the class of the redirected draws in this JVM. */
  static void defineDraws() {
    try {
      MethodHandles.lookup().defineClass(DRAWS_CLASS);
    } catch (IllegalAccessException impossible) {
      throw new AssertionError(impossible);
    }
  }

  private static void draw(CodeBuilder code, String name, MethodTypeDesc type) {
    code.aload(0).invokestatic(REDIRECT, "random", MethodTypeDesc.of(GENERATOR, GENERATOR));
    for (int i = 0; i < type.parameterCount(); i++)
      code.loadLocal(TypeKind.from(type.parameterType(i)), code.parameterSlot(i + 1));
    code.invokeinterface(GENERATOR, name, type).return_(TypeKind.from(type.returnType()));
  }

  private static String internalName(ClassDesc type) {
    var descriptor = type.descriptorString();
    return descriptor.substring(1, descriptor.length() - 1);
  }

  private static final ClassDesc SCHEDULER = ClassDesc.of("org.apache.pekko.actor.Scheduler");
  private static final ClassDesc SYSTEM = ClassDesc.of("org.apache.pekko.actor.ActorSystemImpl");

  /** The classes through which every message to an actor passes, on the sender's thread. */
  private static final Set<String> CELLS =
      Set.of("org/apache/pekko/actor/ActorCell", "org/apache/pekko/actor/UnstartedCell");
  private static final Set<String> DELIVERIES =
      Set.of(
          "sendMessage(Lorg/apache/pekko/dispatch/Envelope;)V",
          "sendSystemMessage(Lorg/apache/pekko/dispatch/sysmsg/SystemMessage;)V");

  static final List<String> PACKAGES = List.of("org/apache/pekko/", "scala/concurrent/");

  private final List<String> packages;
  private final BiConsumer<String, Throwable> failed;

  /**
   * @param packages internal names such as {@code org/apache/pekko/}; classes below them are rewritten
   * @param failed called with a class that could not be rewritten, and the reason
   */
  Rewriter(List<String> packages, BiConsumer<String, Throwable> failed) {
    this.packages = packages;
    this.failed = failed;
  }

  @Override
  public byte[] transform(
      ClassLoader loader, String name, Class<?> redefined, ProtectionDomain domain, byte[] bytes) {
    var isScalaRandom = SCALA_RANDOM.equals(name);
    if (name == null || !isScalaRandom && packages.stream().noneMatch(name::startsWith)) return null;
    try {
      var classFile = ClassFile.of(
          ClassFile.ClassHierarchyResolverOption.of(
              ClassHierarchyResolver.ofResourceParsing(loader).orElse(ClassHierarchyResolver.defaultResolver())));
      var model = classFile.parse(bytes);
      var isCell = CELLS.contains(name);
      var isListener = KILL_SWITCH_LISTENER.equals(name);
      if (!isCell && !isListener && !concerns(model)) return null;
      var transform =
          ClassTransform.transformingMethodBodies(isScalaRandom ? Rewriter::rewriteScalaRandom : Rewriter::rewrite);
      if (isCell) transform = transform.andThen(guarded(model));
      if (isListener) transform = transform.andThen(hashed(model));
      return classFile.transformClass(model, transform);
    } catch (Throwable failure) {
      // The JVM ignores a transformer's exceptions and loads the class unchanged, which would read the wrong
      // clock.
      failed.accept(name, failure);
      return null;
    }
  }

  /** Gives a class a hash code that is read from {@link Redirect#hashCodeOf} once and then kept. */
  private static ClassTransform hashed(ClassModel model) {
    var name = model.thisClass().asSymbol();
    var type = MethodTypeDesc.of(CD_int);
    return ClassTransform.endHandler(
        builder ->
            builder
                .withField("virtualHashCode", CD_int, ClassFile.ACC_PRIVATE)
                .withMethodBody(
                    "hashCode",
                    type,
                    ClassFile.ACC_PUBLIC,
                    code -> {
                      var known = code.newLabel();
                      code.aload(0).getfield(name, "virtualHashCode", CD_int).ifne(known);
                      code.aload(0).aload(0);
                      code.invokestatic(REDIRECT, "hashCodeOf", MethodTypeDesc.of(CD_int, CD_Object));
                      code.putfield(name, "virtualHashCode", CD_int);
                      code.labelBinding(known).aload(0).getfield(name, "virtualHashCode", CD_int).ireturn();
                    }));
  }

  /** Makes each delivery to an actor first call {@link Redirect#delivered} with the system's scheduler. */
  private static ClassTransform guarded(ClassModel cell) {
    var name = cell.thisClass().asSymbol();
    if (cell.methods().stream().filter(Rewriter::isDelivery).count() != DELIVERIES.size())
      throw new IllegalStateException("expected the methods " + DELIVERIES);
    return ClassTransform.transformingMethodBodies(
        Rewriter::isDelivery,
        new CodeTransform() {
          @Override
          public void atStart(CodeBuilder code) {
            code.aload(0)
                .invokevirtual(name, "systemImpl", MethodTypeDesc.of(SYSTEM))
                .invokevirtual(SYSTEM, "scheduler", MethodTypeDesc.of(SCHEDULER))
                .invokestatic(REDIRECT, "delivered", MethodTypeDesc.of(CD_void, CD_Object));
          }

          @Override
          public void accept(CodeBuilder code, CodeElement element) {
            code.with(element);
          }
        });
  }

  private static boolean isDelivery(MethodModel method) {
    return DELIVERIES.contains(method.methodName().stringValue() + method.methodType().stringValue());
  }

  private static boolean concerns(ClassModel model) {
    for (var entry : model.constantPool())
      if (entry instanceof MemberRefEntry member && concerns(key(member))) return true;
    return false;
  }

  private static boolean concerns(String key) {
    return CALLS.containsKey(key) || MAKINGS.containsKey(key) || SUBMISSIONS.contains(key) || SUPERVISOR_NAME.equals(key);
  }

  private static String key(MemberRefEntry member) {
    return member.owner().asInternalName() + "." + member.name().stringValue() + member.type().stringValue();
  }

  private static void rewrite(CodeBuilder code, CodeElement element) {
    switch (element) {
      case InvokeInstruction call -> rewriteCall(code, call);
      case InvokeDynamicInstruction call -> rewriteReferences(code, call);
      default -> code.with(element);
    }
  }

  /**
   * Rewrites method references such as {@code System::nanoTime}, which are arguments of the call that makes
   * the lambda.
   */
  private static void rewriteReferences(CodeBuilder code, InvokeDynamicInstruction call) {
    var arguments = call.bootstrapArgs().stream().map(Rewriter::rewriteReference).toList();
    if (arguments.equals(call.bootstrapArgs())) {
      code.with(call);
    } else {
      var name = call.name().stringValue();
      var rewritten = arguments.toArray(ConstantDesc[]::new);
      code.invokedynamic(DynamicCallSiteDesc.of(call.bootstrapMethod(), name, call.typeSymbol(), rewritten));
    }
  }

  private static ConstantDesc rewriteReference(ConstantDesc argument) {
    if (!(argument instanceof DirectMethodHandleDesc handle)) return argument;
    var key = internalName(handle.owner()) + "." + handle.methodName() + handle.lookupDescriptor();
    var target = MAKINGS.containsKey(key) ? MAKINGS.get(key).factory() : CALLS.get(key);
    if (target == null) return argument;
    return MethodHandleDesc.ofMethod(Kind.STATIC, target.owner(), target.name(), target.type());
  }

  /** Replaces a Scala generator directly after its creation. */
  private static void rewriteScalaRandom(CodeBuilder code, CodeElement element) {
    code.with(element);
    if (element instanceof InvokeInstruction call && UNSEEDED.equals(key(call.method())))
      code.invokestatic(REDIRECT, "governed", MethodTypeDesc.of(JAVA_RANDOM, JAVA_RANDOM));
  }

  private static void rewriteCall(CodeBuilder code, InvokeInstruction call) {
    var key = key(call.method());
    var target = CALLS.get(key);
    var making = MAKINGS.get(key);
    if (making != null) {
      code.invokestatic(REDIRECT, making.parameter().name(), making.parameter().type());
      code.invokespecial(call.method().owner().asSymbol(), "<init>", MethodTypeDesc.of(CD_void, CD_long));
    } else if (target != null && call.opcode() != Opcode.INVOKESPECIAL) {
      code.invokestatic(target.owner(), target.name(), target.type());
    } else {
      if (SUBMISSIONS.contains(key)) {
        // Stack: context, task. The context is copied below the task's copy and handed over, the rest is
        // dropped.
        code.dup2().pop().invokestatic(REDIRECT, "submitted", MethodTypeDesc.of(CD_void, CD_Object));
      }
      code.with(call);
      if (SUPERVISOR_NAME.equals(key))
        code.invokestatic(REDIRECT, "supervisorName", MethodTypeDesc.of(CD_String, CD_String));
    }
  }
}
