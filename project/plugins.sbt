addSbtPlugin("org.scalameta"      % "sbt-scalafmt"        % "2.6.2")
addSbtPlugin("com.github.sbt"     % "sbt-native-packager" % "1.11.1")
addSbtPlugin("pl.project13.scala" % "sbt-jmh"             % "0.4.8")
addSbtPlugin("com.github.sbt"     % "sbt-pgp"             % "2.3.1")
