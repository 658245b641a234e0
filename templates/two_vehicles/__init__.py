"""What `momentum` and `planar-impact` share: the scene, momentum's equations, answers, optional rows, the drawing."""
