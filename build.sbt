import Dependencies.*

ThisBuild / organization         := "io.github.skein-uav"
ThisBuild / organizationName     := "Skein"
ThisBuild / organizationHomepage := Some(url("https://github.com/skein-uav"))
ThisBuild / homepage             := Some(url("https://github.com/skein-uav/skein"))
ThisBuild / licenses             := Seq(License.Apache2)
ThisBuild / scmInfo              := Some(
  ScmInfo(url("https://github.com/skein-uav/skein"), "scm:git:https://github.com/skein-uav/skein.git")
)
ThisBuild / developers := List(
  Developer("skein-uav", "The Skein authors", "", url("https://github.com/skein-uav"))
)
ThisBuild / version       := "0.1.0-SNAPSHOT"
ThisBuild / versionScheme := Some("early-semver")
ThisBuild / publishTo     := localStaging.value
ThisBuild / scalaVersion  := "3.8.4"
ThisBuild / scalacOptions ++= Seq(
  "-Werror",
  "-Wvalue-discard",
  "-deprecation",
  "-feature",
  "-unchecked"
)
// The search for what is unused takes an eighth of the compiler's time or more. Whoever only starts the program has
// changed nothing; classes are equal, so nothing is compiled again with it.
ThisBuild / scalacOptions ++= (if (sys.props.contains("skein.start")) Nil else Seq("-Wunused:all"))
ThisBuild / incOptions ~= (options => options.withIgnoredScalacOptions(options.ignoredScalacOptions :+ "-Wunused.*"))
// What is built at its first start need not wait for archives that nobody publishes: sources and documentation are made
// by an sbt that was started to publish, `./sbtw publishLocal`.
ThisBuild / packageDoc / publishArtifact := Publishing.isWanted
ThisBuild / packageSrc / publishArtifact := Publishing.isWanted
ThisBuild / Test / publishArtifact       := false // else the two above hold for tests, too
ThisBuild / pomPostProcess              := Publishing.withoutTests
ThisBuild / mimaFailOnNoPrevious        := false // what is not published, and what begins a series
ThisBuild / Test / fork               := true
ThisBuild / run / fork                := true
ThisBuild / Test / testForkedParallel := false
ThisBuild / Test / javaOptions ++= Jvm.options
ThisBuild / run / javaOptions ++= Jvm.options
Global / onChangedBuildSource   := ReloadOnSourceChanges
Global / concurrentRestrictions := TestGroups.restrictions

val publishCheck = taskKey[Unit]("fails where a part lacks what a release needs")

// No sockets, no wall clock, no whole flights: for while one works. `test` has all that is not lengthy.
addCommandAlias("testQuick", "testOnly *Suite *Laws *Golden -*LiveSuite")
addCommandAlias("testAll", "cli/stage; python/testedWheel; testOnly *")

lazy val root =
  project
    .in(file("."))
    .aggregate(core, testing, onnx, flow, link, vtime, vtimeAgent, forward, gpu)
    .aggregate(airsim, mavlink, autopilot, hil, offboard, mujoco, scene, simulator, ros, mcap, record, view)
    .aggregate(flight, kafka, observe, rosbag, torture, environment, learn, recognition, blocks, cluster, cli, python)
    .aggregate(bench, docs, chase, ownPolicy, ownScenario, ownGraph, ownVehicle, foreignEnvironment, virtualTime)
    .settings(publish / skip := true, publishCheck := Publishing.check.value, Installing.settings)
    // The API reference of all parts: .ci/docs.
    .enablePlugins(ScalaUnidocPlugin)
    .settings(
      ScalaUnidoc / unidoc / unidocProjectFilter := inDependencies(cli) -- inProjects(testing, vtimeAgent),
      ScalaUnidoc / unidoc / scalacOptions ++= Seq(
        "-project", "Skein",
        "-dynamic-side-menu", // one for all pages: in each, it made a gigabyte
        "-no-link-warnings"   // links of docstrings heed imports
      )
    )
    // The archive and the wheel.
    .settings(
      Compile / Keys.`package` / aggregate := false,
      Compile / Keys.`package`             := {
        val log   = streams.value.log
        val wheel = (python / Wheel.wheel).value
        val file  = Packaging.archive((cli / Packaging.program).value, log)
        log.info(s"$wheel: ${wheel.length >> 20} MiB")
        file
      }
    )

/** What a part is published as: `skein-core` and so on. Its public methods stay within a series of releases. */
def artifact(part: String, does: String): Seq[Setting[?]] = Seq(
  name                  := s"skein-$part",
  description           := does,
  mimaPreviousArtifacts := Publishing.previous(version.value).toSet.map { (released: String) =>
    (organization.value % moduleName.value % released).cross(projectID.value.crossVersion)
  }
)

/** What tests of several modules share. */
lazy val testing = project.in(file("core/testing")).settings(publish / skip := true, libraryDependencies ++= munit.map(_.withConfigurations(None)))

/** Pure: units, signals, vehicle dynamics, policies, scenarios. No Pekko, no I/O. */
lazy val core = project.in(file("core/core"))
  .settings(artifact("core", "Pure: units, signals, dynamics, policies, scenarios"))
  .settings(libraryDependencies ++= munit)

/** ONNX files of dense networks, converted to policies and back. Its library of Protocol Buffers is large. */
lazy val onnx = project.in(file("core/onnx"))
  .settings(artifact("onnx", "ONNX files of dense networks, as policies"))
  .dependsOn(core)
  .settings(libraryDependencies ++= protobuf +: munit)

/** Forward simulation, search, identification, planning. No Pekko. */
lazy val forward = project.in(file("forward/forward"))
  .settings(artifact("forward", "Forward simulation, search, identification, planning"))
  .dependsOn(core % "compile->compile;test->test", testing % Test)
  .settings(Jvm.vectorModule, testsCompute := true, libraryDependencies ++= munit)

/** Forward simulation on NVIDIA's GPUs, by their driver alone. No Pekko. */
lazy val gpu = project.in(file("forward/gpu"))
  .settings(artifact("gpu", "Forward simulation on NVIDIA's GPUs"))
  .dependsOn(forward % "compile->compile;test->test", testing % Test)
  .settings(Jvm.vectorModule, testsCompute := true, libraryDependencies ++= munit)

/** Bodies whose physics is MuJoCo's, by its C library, which is found where it is installed. No Pekko. */
lazy val mujoco = project.in(file("vehicles/mujoco"))
  .settings(artifact("mujoco", "Multirotors whose bodies are MuJoCo's"))
  .dependsOn(forward, testing % Test)
  .settings(libraryDependencies ++= munit)

/** Rewrites clock readings as classes load. Java alone; the JVM is started with its jar as `-javaagent`. */
lazy val vtimeAgent = project
  .in(file("stream/vtime-agent"))
  .settings(artifact("vtime-agent", "Rewrites clock readings of Pekko as classes load"))
  .settings(
    crossPaths       := false,
    autoScalaLibrary := false,
    exportJars       := true,
    Compile / packageBin / packageOptions += Package.ManifestAttributes(
      "Premain-Class" -> "skein.vtime.agent.Agent"
    )
  )

/** For a module whose tests, or whose `run`, need virtual time: start their JVMs with the agent. */
lazy val underAgent = Seq(
  Test / javaOptions += s"-javaagent:${(vtimeAgent / Compile / packageBin).value}",
  run / javaOptions += s"-javaagent:${(vtimeAgent / Compile / packageBin).value}"
)

/** Its program runs in the checkout's root, where it is started: the paths that it prints begin there. */
lazy val atRoot = run / baseDirectory := (ThisBuild / baseDirectory).value

/** Any Pekko graph in virtual time. Depends on Pekko alone. */
lazy val vtime = project.in(file("stream/vtime"))
  .settings(artifact("vtime", "Any Pekko graph in virtual time"))
  .dependsOn(vtimeAgent, testing % Test)
  .settings(underAgent, libraryDependencies ++= pekkoStream ++ munit ++ pekkoTyped.map(_ % Test))

/** Transport, and the emulated network. */
lazy val link = project.in(file("stream/link"))
  .settings(artifact("link", "Transport, and an emulated network"))
  .dependsOn(core, vtime % Test, testing % Test)
  .settings(underAgent, libraryDependencies ++= pekkoStream ++ munit :+ streamTestkit)

/** Operators for control: ordinary Pekko flows, usable with nothing else of ours but the core. */
lazy val flow = project.in(file("stream/flow"))
  .settings(artifact("flow", "Operators for control: ordinary Pekko flows"))
  .dependsOn(core, vtime % Test)
  .settings(underAgent, libraryDependencies ++= pekkoStream ++ munit :+ streamTestkit)

/** MessagePack-RPC; AirSim's typed client and wire. */
lazy val airsim = project.in(file("vehicles/airsim"))
  .settings(artifact("airsim", "MessagePack-RPC and a typed client for AirSim"))
  .dependsOn(link % "compile->compile;test->test", vtime % Test)
  .settings(underAgent, libraryDependencies ++= upickle +: munit ++: Seq(streamTestkit, msgpackOracle))

/** A world to see: scenes, cameras' images, lidars' rays. No Pekko, no I/O, no clock. */
lazy val scene = project.in(file("vehicles/scene"))
  .settings(artifact("scene", "Scenes: drawn by software, scanned by rays"))
  .dependsOn(core)
  .settings(libraryDependencies ++= hocon +: munit)

/** The built-in simulator, which speaks AirSim's wire. */
lazy val simulator = project.in(file("vehicles/simulator"))
  .settings(artifact("simulator", "A simulator of quadrotors that speaks AirSim's wire"))
  .dependsOn(scene, autopilot, hil % "compile->compile;test->test", airsim % "compile->compile;test->test")
  .dependsOn(vtime % Test, testing % Test)
  .settings(underAgent, Test / run / javaOptions ++= Jvm.control, libraryDependencies ++= re2j +: (pekkoTyped ++ munit))

/** The simulator's vehicles as a part of ROS 2, by the C library of an installed one. */
lazy val ros = project.in(file("vehicles/ros"))
  .settings(artifact("ros", "ROS 2 without its build: messages, a node, simulated vehicles behind topics"))
  .dependsOn(simulator % "compile->compile;test->test", testing % Test)
  .settings(underAgent, libraryDependencies ++= munit)

/** The container format of the field's viewers, read and written. Depends on nothing of ours. */
lazy val mcap = project.in(file("record/mcap"))
  .settings(artifact("mcap", "MCAP files, read and written"))
  .dependsOn(testing % Test)
  .settings(libraryDependencies ++= Seq(zstd, lz4, upickle % Test) ++ munit)

/** The field's protocol of vehicles. Depends on nothing of ours. */
lazy val mavlink = project.in(file("vehicles/mavlink"))
  .settings(artifact("mavlink", "MAVLink 2: frames, signatures, the common messages"))
  .settings(libraryDependencies ++= munit)

/** An autopilot's decisions behind MAVLink, as values. No Pekko, no I/O, no clock. */
lazy val autopilot = project.in(file("vehicles/autopilot"))
  .settings(artifact("autopilot", "What an autopilot like PX4 decides and says, as pure functions"))
  .dependsOn(core, mavlink)
  .settings(libraryDependencies ++= munit)

/** What a simulator says to autopilots, and hears of them, as values. No Pekko, no I/O, no clock. */
lazy val hil = project.in(file("vehicles/hil"))
  .settings(artifact("hil", "Sensors with noise for autopilots in simulation: PX4, ArduPilot, Betaflight"))
  .dependsOn(core, mavlink)
  .settings(libraryDependencies ++= munit)

/** Vehicles that speak MAVLink, flown by our loops. */
lazy val offboard = project.in(file("vehicles/offboard"))
  .settings(artifact("offboard", "Vehicles that speak MAVLink, as ports"))
  .dependsOn(core, mavlink, link)
  .settings(libraryDependencies ++= pekkoStream ++ munit)

/** What is in an image: tags, and what any ONNX model finds. An artifact of its own, for its libraries are large. */
lazy val recognition = project.in(file("learn/recognition"))
  .settings(artifact("recognition", "What is in an image: AprilTags, and any ONNX model"))
  .dependsOn(airsim, flight % "test->test")
  .settings(underAgent, libraryDependencies ++= Seq(boofcv, onnxruntime) ++ munit)

/** Work cut into blocks for many machines, each counted once. Depends on nothing. */
lazy val blocks = project.in(file("cluster/blocks"))
  .settings(artifact("blocks", "Work for many machines, each block of it counted once"))
  .dependsOn(core % Test, testing % Test)
  .settings(libraryDependencies ++= munit)

/** Blocks computed by any number of machines that come and go, over Pekko Cluster. */
lazy val cluster = project.in(file("cluster/cluster"))
  .settings(artifact("cluster", "Work on many machines that come and go, counted once, over Pekko Cluster"))
  .dependsOn(blocks, link, testing % Test)
  .settings(libraryDependencies ++= pekkoCluster ++ munit)

/** Recordings. */
lazy val record = project.in(file("record/record"))
  .settings(artifact("record", "Recordings of flights"))
  .dependsOn(core, scene, mcap % "compile->compile;test->test")
  .settings(libraryDependencies ++= Seq(duckdb, postgres, postgresHere, zstd, protobuf) ++ pekkoStream ++ munit)

/** What a browser and Foxglove see of a flight, over WebSockets. */
lazy val view = project.in(file("record/view"))
  .settings(artifact("view", "Flights in the browser and in Foxglove, live and replayed"))
  .dependsOn(link, record % "compile->compile;test->test")
  .settings(libraryDependencies ++= Seq(httpCore, upickle) ++ pekkoStream ++ munit)

/** The loops; flights put together, live and in virtual time. */
lazy val flight = project.in(file("fly/flight"))
  .settings(artifact("flight", "Control loops, and flights put together"))
  .dependsOn(forward, flow, onnx, simulator, offboard, mujoco % "compile->compile;test->test", record % "compile->compile;test->test", vtime)
  .settings(underAgent)
  .settings(libraryDependencies ++= pekkoLog ++ Seq(upickle, pureconfig, progressbar, streamTestkit) ++ munit)

/** Seeded flights through faults, checked from outside. */
lazy val torture = project.in(file("fly/torture"))
  .settings(artifact("torture", "Seeded flights through faults, checked from outside"))
  .dependsOn(flight % "compile->compile;test->test")
  .settings(underAgent, libraryDependencies ++= munit)

/** Any program's loop, measured from between it and its simulator. */
lazy val observe = project.in(file("fly/observe"))
  .settings(artifact("observe", "Any program's control loop, measured from outside"))
  .dependsOn(flight % "compile->compile;test->test", mavlink, link % "test->test")
  .settings(underAgent, libraryDependencies ++= munit)

/** Bags of ROS 2: recordings written as bags, and the loops of bags and graphs measured. */
lazy val rosbag = project.in(file("fly/rosbag"))
  .settings(artifact("rosbag", "Bags of ROS 2: recordings as bags, and what a bag or a graph says of a loop's timing"))
  .dependsOn(observe, ros % "compile->compile;test->test", flight % "test->test")
  .settings(underAgent, libraryDependencies ++= munit)

/** Episodes step by step, for learners. */
lazy val environment = project.in(file("learn/environment"))
  .settings(artifact("environment", "Episodes under a loop's timing, step by step, for learners"))
  .dependsOn(flight, forward % "test->test")
  .settings(testsCompute := true, libraryDependencies ++= munit)

/** Learners of policies. */
lazy val learn = project.in(file("learn/learn"))
  .settings(artifact("learn", "SAC, DDPG and PPO for policies under a loop's timing"))
  .dependsOn(environment, testing % Test)
  .settings(Jvm.vectorModule, testsCompute := true, libraryDependencies ++= munit)

/** Solvers behind a Kafka broker. Kafka's clients are a large library. */
lazy val kafka = project.in(file("fly/kafka"))
  .settings(artifact("kafka", "Solvers behind a Kafka broker"))
  .dependsOn(flight % "compile->compile;test->test")
  .settings(underAgent, libraryDependencies ++= (kafkaClients +: kafkaBroker.map(_ % Test)) ++ munit)

/** Commands and reports. */
lazy val cli = project.in(file("app/cli"))
  .settings(artifact("cli", "Commands and reports"))
  .dependsOn(flight % "compile->compile;test->test", kafka % "compile->compile;test->test")
  .dependsOn(view, learn, cluster, recognition, gpu, rosbag, torture)
  .enablePlugins(JavaAppPackaging)
  .settings(underAgent)
  .settings(
    testsLast := true,
    libraryDependencies ++= Seq(mainargs, logback, scalatags) ++ munit,
    // What runs any model is larger than all the rest; who flies such a policy adds it: docs/guides/onnx.md.
    excludeDependencies += ExclusionRule(onnxruntime.organization, onnxruntime.name),
    Compile / mainClass  := Some("skein.cli.Main"),
    // What a project that ./skein new writes takes from this build.
    Compile / resourceGenerators += Def.task {
      val folder = (Compile / resourceManaged).value / "skein" / "project"
      val home   = (ThisBuild / baseDirectory).value
      val copied = Seq("sbtw", "project/find-jdk", "project/quiet-vectors", "project/build.properties").map { name =>
        val to = folder / file(name).getName
        IO.copyFile(home / name, to)
        to
      }
      val told = Seq("version" -> version.value, "scala-version" -> scalaVersion.value).map { case (name, text) =>
        IO.write(folder / name, text)
        folder / name
      }
      copied ++ told
    }.taskValue,
    executableScriptName := "skein",
    // A suite starts the program as it is staged.
    Test / test := (Test / test).dependsOn(stage).value,
    Packaging.program    := {
      val home = (ThisBuild / baseDirectory).value
      Packaging.build(
        stage.value,
        home / "project" / "packaging",
        Seq("LICENSE", "docs/notice.md").map(home / _),
        (vtimeAgent / Compile / packageBin).value,
        target.value / "package" / s"skein-${version.value}-${Packaging.platform}",
        streams.value.log
      )
    },
    Universal / javaOptions ++= Jvm.nativeAccess.map("-J" + _),
    // The vector module costs no measurable time at the start.
    bashScriptExtraDefines ++= Seq(
      IO.read((ThisBuild / baseDirectory).value / "project" / "java-version").trim,
      s"""addJava "-javaagent:$$lib_dir/${organization.value}.${(vtimeAgent / Compile / packageBin).value.getName}"""",
      IO.read((ThisBuild / baseDirectory).value / "project" / "class-archive").trim,
      """addJava "--add-modules=jdk.incubator.vector"""",
      IO.read((ThisBuild / baseDirectory).value / "project" / "quiet-vectors").trim,
      IO.read((ThisBuild / baseDirectory).value / "project" / "brief-flights").trim,
      """[ -z "$brief" ] || addJava "$brief"""",
      // Whoever chooses a collector or sizes chooses them all.
      """case "${JAVA_OPTS-} $*" in""",
      """  *-Xm[nsx]*|*-XX:+Use*GC*) ;;""",
      s"""  *) ${Jvm.control.map(option => s"addJava $option").mkString("; ")} ;;""",
      """esac""",
      """addJava "-Xlog:disable"""",
      // The packager's script takes the first -- for its own.
      """words=() behind=""",
      """for word in "$@"; do""",
      """  if [ -z "$behind" ] && [ "$word" = -- ]; then behind=1; words+=(--); fi""",
      """  words+=("$word")""",
      """done""",
      """set -- ${words[@]+"${words[@]}"}"""
    )
  )

/** That the Scala of all pages compiles, as a user would compile it. */
lazy val docs = project
  .dependsOn(cli, mcap, mavlink, recognition)
  .settings(
    publish / skip       := true,
    Compile / doc / skip := true,
    scalacOptions -= "-Wunused:all",
    Compile / sourceGenerators += Def.task {
      val root  = (ThisBuild / baseDirectory).value
      val pages = root / "README.md" +: (baseDirectory.value ** "*.md").get()
      Snippets.sources(root, pages, (Compile / sourceManaged).value / "snippets")
    }.taskValue
  )

/** From Python: `skein_uav`. Its tests run by `pytest app/python`, and from here where its packages can be installed. */
lazy val python = project.in(file("app/python"))
  .dependsOn(cli, testing % Test)
  .settings(
    publish / skip := true,
    Wheel.wheel    := Wheel.build(baseDirectory.value, (cli / Packaging.program).value, target.value, streams.value.log),
    Wheel.testedWheel := Def.taskDyn {
      val (why, log) = (target.value / "no-wheel.txt", streams.value.log)
      IO.delete(Seq(why, target.value / "dist"))
      Wheel.obstacle(target.value / "fetched") match {
        case Some(reason) => Def.task { log.warn(s"no wheel is built or tested: $reason"); IO.write(why, reason) }
        case None         => Def.task { Wheel.wheel.value; () }
      }
    }.value,
    libraryDependencies ++= munit
  )

/** Measurements: plain programs that print a witness of what they did. */
lazy val bench =
  project
    .dependsOn(cli, mcap)
    .settings(Jvm.vectorModule, underAgent, testsCompute := true, run / javaOptions ++= Jvm.control)
    .settings(publish / skip := true, libraryDependencies ++= munit)

/** What the README shows: a whole program in a file. */
lazy val chase = project
  .in(file("examples/chase"))
  .dependsOn(cli)
  .settings(publish / skip := true, underAgent, atRoot, libraryDependencies ++= munit)

/** A policy of one's own, flown against the paper's evader. */
lazy val ownPolicy = project
  .in(file("examples/own-policy"))
  .dependsOn(cli)
  .settings(publish / skip := true, underAgent, atRoot, libraryDependencies ++= munit)

/** A scenario of one's own in three dimensions, with its picture and all commands. */
lazy val ownScenario = project
  .in(file("examples/own-scenario"))
  .dependsOn(cli)
  .settings(publish / skip := true, underAgent, atRoot, libraryDependencies ++= munit)

/** The operators on a data source that is not a drone. */
lazy val ownGraph = project
  .in(file("examples/own-graph"))
  .dependsOn(flow, vtime % Test)
  .settings(publish / skip := true, underAgent, libraryDependencies ++= munit)

/** A plain Pekko program, tested in virtual time. */
lazy val virtualTime = project
  .in(file("examples/virtual-time"))
  .dependsOn(vtime % Test)
  .settings(publish / skip := true, underAgent, libraryDependencies ++= pekkoStream ++ munit)

/** A PettingZoo environment, flown by our loops. */
lazy val foreignEnvironment = project
  .in(file("examples/foreign-environment"))
  .dependsOn(cli)
  .settings(publish / skip := true, underAgent)

/** Ground robots with a simulator and a protocol of their own, driven by our loops. */
lazy val ownVehicle = project
  .in(file("examples/own-vehicle"))
  .dependsOn(cli, testing % Test)
  .settings(publish / skip := true, underAgent, libraryDependencies ++= munit, testsCompute := true)
  .settings(Compile / run / mainClass := Some("rovers.driveRovers"))
