# install rules live here; written with the exported package
